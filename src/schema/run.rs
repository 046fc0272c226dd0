//! The tables of one surface and of one of its cycles.

use super::event_kinds::{KINDS_DOC, OF_STEPS};
use super::{CYCLE_ID, Column, REALIZATION, SURFACE_ID, Table, count, flag, index, join, real, text};

pub(super) const CYCLE_CASE_ID: Column = text(
    "case_id",
    "Identifier of the case, computed without the as_printed entries that only the analytical estimates use; \
     the table cycles lists every case of the cycle",
);
pub(super) const BRANCH: Column = text("branch", "\"loading\" or \"unloading\"");
pub(super) const MAX_LOAD: Column = real(
    "max_load",
    "1",
    "Normal load F_max/(E* A0) at the load reversal from which this unloading starts; null for loading, \
     which is common to all load reversals",
)
.or_null();
/// Null in tables that were written before there was another method.
const METHOD: Column = text(
    "method",
    "Method: \"asperities\" or \"boundary_elements\"; null in tables of earlier versions (asperities)",
)
.or_null();
pub(super) const STEP: Column =
    index("step", "Number of the output step along the path of the cycle, from 0");
const ASPERITY: Column = index(
    "asperity_id",
    "Number of the asperity in the table asperities; larger numbers are merged contacts, listed in the table \
     merged",
);
pub(super) const ASPERITY_OR_REGION: Column = index(
    "asperity_id",
    "Number of the asperity in the table asperities; larger numbers are merged contacts, listed in the table \
     merged; null for boundary elements",
)
.or_null();

/// The summits of one surface.
pub static ASPERITIES: Table = Table {
    name: "asperities",
    version: 1,
    file: "asperities/<id>.parquet",
    doc: "One row per asperity: a local maximum of the surface with positive mean curvature.",
    columns: &[
        SURFACE_ID,
        REALIZATION,
        index("asperity_id", "Number of the asperity on its surface, from 0"),
        real("x_m", "m", "Peak position x; the row index of the height field runs along x"),
        real("y_m", "m", "Peak position y; the column index of the height field runs along y"),
        real("height_m", "m", "Peak height above the mean plane of the surface"),
        real("radius_m", "m", "Radius of curvature R of the asperity, the inverse of its mean curvature"),
        real(
            "curvature_1_m",
            "1/m",
            "Mean curvature at the peak, -1/2 of the Laplacian of the height; positive at a summit",
        )
        .from("Nayak 1971"),
        real("curvature_min_1_m", "1/m", "Smaller principal curvature at the peak; positive at a summit"),
        real("curvature_max_1_m", "1/m", "Larger principal curvature at the peak; positive at a summit"),
        index("grid_row", "Row index of the local maximum in the height field"),
        index("grid_col", "Column index of the local maximum in the height field"),
        flag("refined", "True if position and height were interpolated between grid points"),
    ],
};

const STEP_BEFORE_COUNTS: &[Column] = &[
    CYCLE_ID,
    CYCLE_CASE_ID,
    REALIZATION,
    STEP,
    BRANCH,
    MAX_LOAD,
    real(
        "approach_m",
        "m",
        "Mean penetration Δ of the rigid rough surface; 0 where the highest asperity touches the undeformed \
         half-space",
    ),
    real(
        "load_n",
        "N",
        "Normal load F, summed over all contact spots or grid points; positive in \
         compression, negative in tension",
    )
    .from("Eq 1"),
    real(
        "least_load_n",
        "N",
        "Minimum normal load since the previous step, including the states directly before and after events, \
         where the load is discontinuous",
    ),
    real(
        "area_m2",
        "m^2",
        "Contact area A, summed over the discs of all contact spots, or over the grid \
         points in contact",
    ),
    real(
        "area_union_m2",
        "m^2",
        "Area of the union of all contact discs, in which overlaps count once; equal to area_m2 for boundary \
         elements; null where it was not computed",
    )
    .or_null(),
    count("contact_count", "Asperities in contact, or connected contact regions of boundary elements"),
    count(
        "covered_count",
        "Asperities absorbed by a larger contact spot, without load and area of their own",
    ),
];

const STEP_AFTER_COUNTS: &[Column] = &[
    count(
        "held_count",
        "Frozen asperities: state kept in this step, because it alternated between absorbed \
         and released",
    ),
    count(
        "touching_count",
        "Contact spots that overlap a neighbour: distance below the sum of the contact \
         radii",
    ),
    real("dissipated_j", "J", "Energy dissipated in the events since the previous step"),
    real(
        "work_j",
        "J",
        "Work done on the contact since the start of the branch: integral of the normal load over the mean \
         penetration",
    ),
    real(
        "residual_m",
        "m",
        "Residual of the equilibrium: maximum over all contact spots of |local \
         penetration - JKR penetration|; null for boundary elements",
    )
    .or_null()
    .from("Eqs 2, 5"),
    real(
        "drift_m",
        "m",
        "Predictor residual: maximum residual of the global problem before its solution, since the previous \
         step; the error of the local solutions after events; null for boundary elements",
    )
    .or_null(),
    real(
        "stability",
        "1",
        "Smallest eigenvalue of the tangent of penetration with respect to contact radius, each column over \
         its diagonal element: 1 without interaction, 0 at a limit point, negative for an unstable \
         equilibrium; null for boundary elements",
    )
    .or_null(),
    flag("converged", "True if the residual is below the tolerance"),
    count(
        "iteration_count",
        "Iterations of Newton's method and of relaxation since the previous step, in \
         local and global problems",
    ),
    count(
        "pair_evaluation_count",
        "Evaluations of the displacement of one contact by another since the \
         previous step",
    ),
    count(
        "product_count",
        "Matrix-vector products of the tangent since the previous step, one per Krylov \
         iteration",
    ),
    count(
        "transform_count",
        "Fourier transforms of a mesh or grid since the previous step; those of a patch \
         count by their points",
    ),
    real("load", "1", "Normal load F/(E* A0); positive in compression"),
    real("area", "1", "Contact area A/A0, summed over the discs of all contact spots"),
    real("penetration", "1", "Mean penetration Δ/h_rms"),
    METHOD,
    real(
        "residual",
        "1",
        "Residual of the equilibrium of boundary elements: rms of the pressure residual \
         over the maximum tension; null for asperities",
    )
    .or_null(),
    real(
        "stiffness_n_m",
        "N/m",
        "Stiffness dF/dΔ of the contact of boundary elements at constant bonds; \
         null for asperities",
    )
    .or_null(),
    real("stiffness", "1", "Stiffness dF/dΔ of boundary elements over E* A0/h_rms; null for asperities")
        .or_null(),
    real(
        "reversal_load",
        "1",
        "Load F_max/(E* A0) of the spec whose reversal is at this step; null elsewhere",
    )
    .or_null(),
    real(
        "machine_displacement_m",
        "m",
        "Displacement Δ + cF of the machine, which is controlled, with the compliance c of its spring; null \
         under control of the load",
    )
    .or_null(),
];

const STEP_COLUMNS: [Column; STEP_BEFORE_COUNTS.len() + OF_STEPS.len() + STEP_AFTER_COUNTS.len()] =
    join(&[STEP_BEFORE_COUNTS, &OF_STEPS, STEP_AFTER_COUNTS]);

/// The path of one cycle, step by step.
pub static STEPS: Table = Table {
    name: "steps",
    version: 1,
    file: "cycles/<id>/steps.parquet",
    doc: "One row per output step of loading, and of unloading from each load reversal.",
    columns: &STEP_COLUMNS,
};

/// The contact spots at the steps that are kept.
pub static CONTACTS: Table = Table {
    name: "contacts",
    version: 1,
    file: "cycles/<id>/contacts.parquet",
    doc: "One row per asperity in contact or absorbed, or per connected contact region of boundary elements, \
         at each step selected by cycle.contacts.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        STEP,
        BRANCH,
        MAX_LOAD,
        ASPERITY_OR_REGION,
        text("state", "\"contact\" or \"covered\" (absorbed); free asperities have no row"),
        real("contact_radius_m", "m", "Contact radius a; 0 if absorbed; sqrt(area/π) of a region")
            .from("Eq 2"),
        real(
            "load_n",
            "N",
            "Normal load of the contact spot or region; positive in compression, 0 if \
             absorbed. By boundary elements without the tension of open points around a region, so the sum \
             is not the load of the step",
        )
        .from("Eq 1"),
        real(
            "penetration_m",
            "m",
            "Local penetration δ, including the displacement by all other contacts; null if absorbed, and \
             for a region",
        )
        .or_null()
        .from("Eq 5"),
        real(
            "interaction_m",
            "m",
            "Normal displacement of the half-space by all other contacts; null if \
             absorbed, and for a region",
        )
        .or_null()
        .from("Eqs 6-8"),
        METHOD,
        real(
            "centroid_x_m",
            "m",
            "Centre x of a contact spot, that of its asperity or merged contact; of \
             boundary elements, centroid x of a region on the periodic square",
        )
        .or_null(),
        real("centroid_y_m", "m", "Centre y of a contact spot, as above").or_null(),
        real("area_m2", "m^2", "Area of a region; null for asperities").or_null(),
        real("perimeter_m", "m", "Length of the edge of a region (Crofton's formula); null for asperities")
            .or_null(),
        count(
            "summit_count",
            "Asperities of the table asperities inside a region, those of mirror images \
             included; null for asperities",
        )
        .or_null(),
    ],
};

/// States at load reversal.
pub static TURNING: Table = Table {
    name: "turning",
    version: 1,
    file: "cycles/<id>/turning.parquet",
    doc: "One row per asperity that is in contact, absorbed, merged or blocked from re-contact, at each load \
         reversal; sufficient to restart the unloading.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        real("max_load", "1", "Normal load F_max/(E* A0) at the load reversal"),
        real("approach_m", "m", "Mean penetration Δ at the load reversal, with the zero of the table steps"),
        ASPERITY,
        text(
            "state",
            "\"contact\", \"covered\" (absorbed), \"merged\", or \"free\" if it is blocked from \
             re-contact",
        ),
        real("contact_radius_m", "m", "Contact radius a; 0 without contact").from("Eq 2"),
        index("covered_by", "asperity_id of the absorbing contact; null if not absorbed").or_null(),
        real(
            "release_m",
            "m",
            "Contact radius of the absorbing contact below which this asperity is \
             released; null if not absorbed",
        )
        .or_null(),
        flag(
            "barred",
            "True if blocked from re-contact after a jump out of contact, until its penetration falls below \
             the jump-in distance",
        ),
        index(
            "merged_into",
            "asperity_id of the merged contact that contains this one; null if there is none",
        )
        .or_null(),
        count("merged_count", "Number of rows of the table merged at this load reversal, from the first row"),
    ],
};

/// Loading without adhesion.
pub static ADHESIONLESS: Table = Table {
    name: "adhesionless",
    version: 1,
    file: "cycles/<id>/adhesionless.parquet",
    doc: "One row per step of loading the same surface without adhesion, by boundary elements; from it \
         follow the columns *_jkr_curve of the table realizations.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        STEP,
        real("approach_m", "m", "Mean penetration Δ, with the zero of the table steps"),
        real("load_n", "N", "Normal load; positive in compression"),
        real("area_m2", "m^2", "Contact area"),
        flag("converged", "True if the residual is below the tolerance"),
        count("transform_count", "Fourier transforms"),
    ],
};

/// Merged contacts.
pub static MERGED: Table = Table {
    name: "merged",
    version: 1,
    file: "cycles/<id>/merged.parquet",
    doc: "One row per merged contact (coalescence \"merge\"), in order of merging.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        STEP,
        BRANCH,
        MAX_LOAD,
        index(
            "asperity_id",
            "Number of the merged contact; numbers follow those of the asperities and, during unloading, \
             those of the load reversal",
        ),
        real("approach_m", "m", "Mean penetration Δ at merging, with the zero of the table steps"),
        index("first_id", "asperity_id of the first contact, an asperity or a merged contact"),
        index("second_id", "asperity_id of the second contact, an asperity or a merged contact"),
        real("first_radius_m", "m", "Contact radius of the first contact at merging"),
        real("second_radius_m", "m", "Contact radius of the second contact at merging"),
        real("release_m", "m", "Contact radius at which the merged contact splits"),
        real("x_m", "m", "Centre x, the area-weighted mean of both contacts"),
        real("y_m", "m", "Centre y, the area-weighted mean of both contacts"),
        real("height_m", "m", "Peak height relative to the highest asperity").from("Eq 5"),
        real(
            "radius_m",
            "m",
            "Radius of curvature of the equivalent sphere with the same contact radius and load",
        )
        .from("Eq 1"),
        real(
            "offset_j",
            "J",
            "Constant of its potential, with which merging neither creates nor dissipates energy",
        ),
    ],
};

/// Changes of state of single asperities.
pub static EVENTS: Table = Table {
    name: "events",
    version: 1,
    file: "cycles/<id>/events.parquet",
    doc: "One row per change of state of an asperity, or per sudden change of the contact of boundary \
         elements.",
    columns: &[
        CYCLE_ID,
        CYCLE_CASE_ID,
        REALIZATION,
        STEP,
        BRANCH,
        MAX_LOAD,
        text("kind", KINDS_DOC),
        ASPERITY_OR_REGION,
        real("approach_m", "m", "Mean penetration Δ at the event, with the zero of the table steps")
            .from("Eqs 3, 4"),
        index(
            "avalanche_id",
            "Number of the avalanche, from 0 along the path; all events caused by one \
             instability share it",
        ),
        real("load_before_n", "N", "Normal load before the event, summed over all contact spots"),
        real(
            "load_after_n",
            "N",
            "Normal load in the equilibrium after the event, summed over all contact \
             spots",
        ),
        real("area_before_m2", "m^2", "Contact area before the event, summed over all contact spots"),
        real(
            "area_after_m2",
            "m^2",
            "Contact area in the equilibrium after the event, summed over all \
             contact spots",
        ),
        real(
            "energy_lost_j",
            "J",
            "Energy dissipated in the event and the relaxation that follows; 0 for further events of the \
             same relaxation",
        ),
        METHOD,
        text(
            "status",
            "Status of the asperity after the relaxation: \"free\", \"contact\", \"covered\" (absorbed), \
             \"merged\" (part of a merged contact), or \"split\" (merged contact whose two parts are in \
             contact again); null for boundary elements",
        )
        .or_null(),
        text(
            "cause",
            "Kind of the event that causes the relaxation: its first event, or the merging or splitting \
             before it in the avalanche that left the contact out of equilibrium; the columns dissipated_* \
             of the table realizations sum energy_lost_j by it; of boundary elements the kind itself",
        ),
    ],
};
