//! The tables of one surface and of one of its cycles.

use super::{CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, count, flag, index, real, text};

const CYCLE_CASE_ID: Column = text(
    "case_id",
    "Identity of the case, without the entries of as_printed that only analytical estimates read; the table cycles lists every case of the cycle",
);
const BRANCH: Column = text("branch", "\"loading\" or \"unloading\"");
const MAX_LOAD: Column = real(
    "max_load",
    "1",
    "F/(E* A0) from which this unloading began; null while loading, since one loading path serves every turning point",
)
.or_null();
const STEP: Column = index("step", "Number of the step along the whole path, from 0");
const ASPERITY: Column =
    index("asperity_id", "The asperity, as in the table asperities; numbers beyond its last are merged spots, as in the table merged");

/// The summits of one surface.
pub static ASPERITIES: Table = Table {
    name: "asperities",
    version: 1,
    file: "asperities/<id>.parquet",
    doc: "One row per summit of a surface that can come into contact.",
    columns: &[
        SURFACE_ID,
        REALIZATION,
        index("asperity_id", "Number of the asperity on its surface, from 0"),
        real("x_m", "m", "x of the apex; the rows of the height field count along x"),
        real("y_m", "m", "y of the apex; the columns of the height field count along y"),
        real("height_m", "m", "Height of the apex above the mean plane of the surface"),
        real("radius_m", "m", "Radius of the sphere that stands for the summit, the inverse of its mean curvature"),
        real("curvature_1_m", "1/m", "Mean curvature at the apex, half the negative Laplacian of the height; positive at a summit")
            .from("Nayak 1971"),
        real("curvature_min_1_m", "1/m", "Smaller principal curvature at the apex; positive at a summit"),
        real("curvature_max_1_m", "1/m", "Greater principal curvature at the apex; positive at a summit"),
        index("grid_row", "Row of the grid point that is the local maximum"),
        index("grid_col", "Column of the grid point that is the local maximum"),
        flag("refined", "Whether height and position were refined to the apex between grid points"),
    ],
};

/// The path of one cycle, step by step.
pub static STEPS: Table = Table {
    name: "steps",
    version: 1,
    file: "cycles/<id>/steps.parquet",
    doc: "One row per step of loading, and of unloading from each turning point.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        STEP,
        BRANCH,
        MAX_LOAD,
        real(
            "approach_m",
            "m",
            "Approach of the rigid rough surface, which is its mean penetration; 0 where the highest summit meets the undeformed half-space",
        ),
        real("load_n", "N", "Normal load, the sum over all contact spots; negative in tension").from("Eq 1"),
        real(
            "least_load_n",
            "N",
            "Least load since the step before, events included: the load is a saw-tooth whose teeth stand at the events",
        ),
        real("area_m2", "m^2", "Contact area, the sum of the discs of all contact spots"),
        real("area_union_m2", "m^2", "Contact area, the union of the discs, overlaps counted once; null where it was not computed")
            .or_null(),
        count("contact_count", "Asperities in contact"),
        count("covered_count", "Asperities covered by a greater spot: they carry nothing"),
        count("jump_in_count", "Asperities that jumped into contact in this step"),
        count("jump_off_count", "Asperities that jumped out of contact in this step"),
        count("cover_count", "Asperities that were covered in this step"),
        count("uncover_count", "Asperities that were uncovered in this step"),
        count("snap_count", "Moves of the contact to another equilibrium with the same spots in this step"),
        count("merge_count", "Spots that became one with another in this step"),
        count("split_count", "Merged spots that parted in this step"),
        count("held_count", "Asperities held as they are since they flipped between covered and uncovered in this step"),
        count("touching_count", "Contact spots that touch another one"),
        real("dissipated_j", "J", "Energy lost in the events of this step"),
        real("work_j", "J", "Work done on the contact since this branch began, the integral of load over approach"),
        real("residual_m", "m", "Greatest difference left between local penetration and JKR penetration, over all spots").from("Eqs 2, 5"),
        real(
            "drift_m",
            "m",
            "Greatest residual that the whole contact had since the step before when it came to be solved: what the neighbourhoods of events had left out",
        ),
        real(
            "stability",
            "1",
            "Least eigenvalue of the tangent of penetration to contact radius, each column over its own diagonal element: 1 without coupling, 0 at a fold, negative where the equilibrium repels",
        ),
        flag("converged", "Whether the residual came below the tolerance"),
        count(
            "iteration_count",
            "Iterations of Newton's method and of relaxations since the step before, of neighbourhoods and of the whole contact",
        ),
        count("pair_evaluation_count", "Evaluations of the displacement field of one spot at another since the step before"),
        count("product_count", "Products of the tangent with a vector since the step before: one for each Krylov iteration"),
        count("transform_count", "Fourier transforms of a mesh since the step before"),
        real("load", "1", "F/(E* A0)"),
        real("area", "1", "A/A0"),
        real("penetration", "1", "Approach over rms height"),
    ],
};

/// The contact spots at the steps that are kept.
pub static CONTACTS: Table = Table {
    name: "contacts",
    version: 1,
    file: "cycles/<id>/contacts.parquet",
    doc: "One row per asperity in contact or covered, at each step that the spec keeps.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        STEP,
        BRANCH,
        MAX_LOAD,
        ASPERITY,
        text("state", "\"contact\" or \"covered\"; free asperities have no row"),
        real("contact_radius_m", "m", "Radius of the contact spot; 0 if covered").from("Eq 2"),
        real("load_n", "N", "Load of the contact spot; 0 if covered").from("Eq 1"),
        real("penetration_m", "m", "Local penetration, after the displacement by all other spots; null if covered").or_null().from("Eq 5"),
        real("interaction_m", "m", "Displacement of the half-space by all other spots; null if covered").or_null().from("Eqs 6-8"),
    ],
};

/// The states from which unloading begins.
pub static TURNING: Table = Table {
    name: "turning",
    version: 1,
    file: "cycles/<id>/turning.parquet",
    doc: "One row per asperity that is not simply free, at each turning point: all that is needed to unload from there again.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        real("max_load", "1", "F/(E* A0) at which the path turns"),
        real("approach_m", "m", "Approach of the surface at the turning point, zero as in the table steps"),
        ASPERITY,
        text("state", "\"contact\", \"covered\", \"merged\", or \"free\" if it has left and does not return yet"),
        real("contact_radius_m", "m", "Radius of the contact spot; 0 if there is none").from("Eq 2"),
        index("covered_by", "The asperity whose spot covers it; null if none does").or_null(),
        real("release_m", "m", "Radius of the covering spot below which it is uncovered; null if none covers it").or_null(),
        flag("barred", "Whether it has left and stays free until its penetration falls below its jump-in distance"),
        index("merged_into", "The merged spot of which it is a part; null if it is none").or_null(),
        count("merged_count", "How many rows of the table merged, from the first, there were by then"),
    ],
};

/// Spots that stand for two.
pub static MERGED: Table = Table {
    name: "merged",
    version: 1,
    file: "cycles/<id>/merged.parquet",
    doc: "One row per spot that two touching ones became (coalescence \"merge\"), in the order in which they did.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        STEP,
        BRANCH,
        MAX_LOAD,
        index("asperity_id", "Its number: they follow those of the asperities, and on unloading those of the turning point"),
        real("approach_m", "m", "Approach of the surface where they merged, zero as in the table steps"),
        index("first_id", "One of the two, an asperity or a merged spot"),
        index("second_id", "The other one"),
        real("first_radius_m", "m", "Contact radius of the first one when they merged"),
        real("second_radius_m", "m", "Contact radius of the second one when they merged"),
        real("release_m", "m", "Contact radius of the merged spot at which it parts"),
        real("x_m", "m", "x of its centre, the area-weighted one of the two"),
        real("y_m", "m", "y of its centre"),
        real("height_m", "m", "Height of its apex over the highest summit").from("Eq 5"),
        real("radius_m", "m", "Radius of the sphere that has its contact radius and its load").from("Eq 1"),
    ],
};

/// What happened to single asperities.
pub static EVENTS: Table = Table {
    name: "events",
    version: 1,
    file: "cycles/<id>/events.parquet",
    doc: "One row per asperity that changed its state.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        STEP,
        BRANCH,
        MAX_LOAD,
        text(
            "kind",
            "What happened: \"jump_in\", \"jump_off\", \"cover\", \"uncover\", \"merge\", \"split\", and \"snap\" where the contact moves to another equilibrium with the same spots",
        ),
        ASPERITY,
        real("approach_m", "m", "Approach of the surface at the event, zero as in the table steps").from("Eqs 3, 4"),
        index("avalanche_id", "Events that one instability brought about have the same number, from 0 along the path"),
        real("load_before_n", "N", "Load of the whole contact before the event"),
        real("load_after_n", "N", "Load of the whole contact when the rest has relaxed"),
        real("area_before_m2", "m^2", "Area of the whole contact before the event"),
        real("area_after_m2", "m^2", "Area of the whole contact when the rest has relaxed"),
        real(
            "energy_lost_j",
            "J",
            "Energy lost in the event and in the relaxation that followed it; 0 for further events of the same relaxation",
        ),
    ],
};
