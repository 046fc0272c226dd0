"""Plots of a run with matplotlib: `pip install "hysteron[plot]"`.

    import hysteron
    run = hysteron.load("data/runs/quickstart")
    hysteron.plot.loop(run)

The colour is the case, the dash is the branch: loading dashed, unloading solid. Each function draws into `ax`, or into new axes,
and returns the axes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._run import case_names

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._run import Maps, Run

#: Colours of cases.
PALETTE = ("#7b3294", "#009e73", "#e69f00", "#cc79a7", "#808000", "#6b472b")
#: Compression and tension in maps.
COMPRESSION, TENSION = "#0072b2", "#c0281c"


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        raise ImportError('cannot plot: matplotlib is not installed\nhelp: pip install "hysteron[plot]"') from None
    return plt.subplots(layout="constrained")[1]


def _cycle(run: Run, id: str | None) -> str:
    """A cycle; by default the one of the report."""
    ids = run.cycle_ids
    if not ids:
        raise ValueError(f"cannot plot {run.dir}: no cycle is finished\nhelp: run `hysteron run SPEC`")
    if id is not None:
        return id
    if "statistics/cases" not in run:
        return ids[0]
    case, method, loss = _columns(run.cases, "case_id", "method", "loss_mean")
    means = np.where(np.isnan(loss.astype(float)), -np.inf, loss.astype(float))
    order = np.lexsort((-means, method != "asperities"))
    cycles = run["statistics/cycles"]
    of_case, names = _columns(cycles, "case_id", "cycle_id")
    found = (name for row in order for name in names[of_case == case[row]] if name in ids)
    return str(next(found, ids[0]))


def _columns(table: Any, *names: str) -> list[Any]:
    return [np.array(table[name].to_pylist(), dtype=object if table[name].type == "string" else None) for name in names]


def _paths(table: Any, max_load: float | None) -> tuple[float, Any, Any]:
    """The load reversal, and the rows of loading up to it and of unloading."""
    branch, of, reversal = _columns(table, "branch", "max_load", "reversal_load")
    of, reversal = of.astype(float), reversal.astype(float)
    largest = np.nanmax(of) if max_load is None else max_load
    up = np.flatnonzero(branch == "loading")
    down = np.flatnonzero((branch == "unloading") & np.isclose(of, largest, rtol=1e-9, atol=0))
    if not down.size:
        raise ValueError(f"no unloading from F_max/(E* A0) = {largest}\nhelp: use one of {sorted(set(of[np.isfinite(of)]))}")
    return float(largest), up[: np.flatnonzero(np.isclose(reversal[up], largest, rtol=1e-9, atol=0))[0] + 1], down


def loop(run: Run, id: str | None = None, max_load: float | None = None, ax: Axes | None = None) -> Axes:
    """Normal force against mean penetration of one cycle.

    Parameters
    ----------
    run : Run
        Output directory of a run.
    id : str, optional
        Cycle. Default: as in the report, the asperity model's case with the largest mean dissipated energy.
    max_load : float, optional
        Load reversal F_max/(E* A0). Default: the largest one.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = _axes(ax)
    steps = run.steps(_cycle(run, id))
    largest, up, down = _paths(steps, max_load)
    penetration, load = _columns(steps, "penetration", "load")
    ax.plot(penetration[up], load[up], "--", color=PALETTE[0], label="loading")
    ax.plot(penetration[down], load[down], "-", color=PALETTE[0], label="unloading")
    ax.set(xlabel=r"$\Delta/h_\mathrm{rms}$", ylabel="$F/(E^*A_0)$", title=rf"$F_\mathrm{{max}}/(E^*A_0)$ = {largest:.4g}")
    ax.legend(frameon=False)
    return ax


def curves(run: Run, quantity: str = "area", ax: Axes | None = None) -> Axes:
    """Mean curves of all cases against the normal force, with bands of one standard deviation.

    Parameters
    ----------
    run : Run
        Output directory of a run.
    quantity : str
        "area" (A/A0) or "penetration" (Δ/h_rms).
    ax : matplotlib.axes.Axes, optional
        Axes to draw into.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = _axes(ax)
    table = run.curves
    case, branch, of, load, mean, sd = _columns(table, "case_id", "branch", "max_load", "load", f"{quantity}_mean", f"{quantity}_sd")
    of, sd = of.astype(float), sd.astype(float)
    names = case_names(run.cases)
    for place, name in enumerate(dict.fromkeys(case)):
        colour = PALETTE[place % len(PALETTE)]
        rows = np.flatnonzero((case == name) & (branch == "loading"))
        ax.plot(load[rows], mean[rows], "--", color=colour)
        loads = of[(case == name) & (branch == "unloading")]
        for max_load in sorted(set(loads)):
            rows = np.flatnonzero((case == name) & (branch == "unloading") & (of == max_load))
            low = mean[rows] - sd[rows]
            ax.fill_between(load[rows], np.maximum(low, 0) if quantity == "area" else low, mean[rows] + sd[rows], color=colour, alpha=0.13, lw=0)
            ax.plot(load[rows], mean[rows], "-", color=colour, label=names[name] if max_load == max(loads) else None)
    ax.set(xlabel="$F/(E^*A_0)$", ylabel={"area": "$A/A_0$", "penetration": r"$\Delta/h_\mathrm{rms}$"}[quantity])
    ax.legend(frameon=False)
    return ax


def contacts(run: Run, id: str | None = None, step: int | None = None, ax: Axes | None = None) -> Axes:
    """Contact of one cycle at a stored step.

    Contact spots of the asperity model are discs, blue if compressive and red if tensile. Boundary elements have the real shapes from the stored maps,
    coloured by the pressure: blue is compressive, red tensile. These need h5py.

    Parameters
    ----------
    run : Run
        Output directory of a run.
    id : str, optional
        Cycle. Default: the asperity model's case with the largest mean dissipated energy; of a run without asperity model, that of boundary elements.
    step : int, optional
        Stored step: one of the column `step` of the table `contacts`, or of `Run.maps(id).steps`. Default: the one with the most contact spots, and
        the map with the largest load.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = _axes(ax)
    cycle = _cycle(run, id)
    if (run.dir / "cycles" / cycle / "maps.h5").is_file():
        whole = run.maps(cycle, whole=True)
        return _regions(whole if step is None or step in whole.steps else run.maps(cycle), step, ax)
    return _spots(run, cycle, step, ax)


def _regions(maps: Maps, step: int | None, ax: Axes) -> Axes:
    """Regions of contact of boundary elements, coloured by the pressure."""
    from matplotlib.colors import LinearSegmentedColormap, TwoSlopeNorm

    if not maps.steps.size:
        raise ValueError("the cycle has no stored maps\nhelp: give another cycle")
    if step is not None and step not in maps.steps:
        raise ValueError(f"no map is stored at step {step}\nhelp: use one of {maps.steps.tolist()}")
    k = int(np.argmax(maps.loads_n)) if step is None else int(np.flatnonzero(maps.steps == step)[0])
    touches = maps.in_contact()[k]
    pressure = 1e-6 * np.where(touches, maps.pressure_pa[k], np.nan)
    low, high = (float(extreme(pressure[touches], initial=0.0)) for extreme in (np.min, np.max))
    shades = ["#a0140f", "#f6cec4", "#ffffff", "#bed7ee", "#003c6e"]
    colours = LinearSegmentedColormap.from_list("pressure", shades).with_extremes(bad="#f2f2f2")
    norm = TwoSlopeNorm(0.0, min(low, -1e-12 * max(high, 1.0)), max(high, 1e-12 * max(-low, 1.0)))
    side = 1e6 * maps.length_m
    image = ax.imshow(pressure.T, origin="lower", extent=(0, side, 0, side), cmap=colours, norm=norm, interpolation="nearest")
    ax.figure.colorbar(image, ax=ax, label="pressure [MPa]")
    title = f"step {maps.steps[k]}, {maps.branches[k]}: A/A₀ = {touches.mean():.3f}"
    ax.set(xlim=(0, side), ylim=(0, side), aspect="equal", xlabel="x [µm]", ylabel="y [µm]", title=title)
    return ax


def _spots(run: Run, cycle: str, step: int | None, ax: Axes) -> Axes:
    """Contact spots of the asperity model."""
    from matplotlib.collections import EllipseCollection

    table = run.contacts(cycle)
    number, state, radius, load = _columns(table, "step", "state", "contact_radius_m", "load_n")
    touching = state == "contact"
    if step is None:
        known, counts = np.unique(number[touching], return_counts=True)
        if not known.size:
            raise ValueError(f"the cycle {cycle} has no stored contacts\nhelp: set `cycle.contacts` to \"turning\" or \"all\" in the spec")
        step = int(known[np.argmax(counts)])
    rows = np.flatnonzero(touching & (number == step))
    centres = np.stack(_columns(table, "centroid_x_m", "centroid_y_m"), axis=1)[rows].astype(float)
    colours = np.where(load[rows].astype(float) < 0, TENSION, COMPRESSION)
    diameter = 2e6 * radius[rows].astype(float)
    spots = EllipseCollection(diameter, diameter, np.zeros(rows.size), units="xy", offsets=1e6 * centres, facecolors=colours, alpha=0.85)
    ax.add_collection(spots)
    spots.set_offset_transform(ax.transData)
    side = 1e6 * _side(run, cycle)
    ax.set(xlim=(0, side), ylim=(0, side), aspect="equal", xlabel="x [µm]", ylabel="y [µm]", title=f"step {step}: {rows.size} contact spots")
    return ax


def _facts(run: Run, cycle: str, column: str) -> Any:
    table = run["statistics/cycles"]
    return table[column][table["cycle_id"].to_pylist().index(cycle)].as_py()


def _side(run: Run, cycle: str) -> float:
    return float(_facts(run, cycle, "length_m"))


def spectrum(run: Run, id: str | None = None, ax: Axes | None = None) -> Axes:
    """Radially averaged power spectral density of the heights of a surface, with ∫C d²q = h_rms². Requires h5py.

    SurfaceTopography and contact.engineering use ∫C d²q/(4π²) = h_rms²: their C is 4π² = 39.48 times as large.

    Parameters
    ----------
    run : Run
        Output directory of a run.
    id : str, optional
        Surface. Default: the first one.
    ax : matplotlib.axes.Axes, optional
        Axes to draw into.

    Returns
    -------
    matplotlib.axes.Axes
    """
    ax = _axes(ax)
    import h5py

    name = run.surface_ids[0] if id is None else id
    heights = run.surface(name)
    with h5py.File(run.dir / "surfaces" / f"{name}.h5") as file:
        side = float(file.attrs["length_m"])
    points = heights.shape[0]
    power = np.abs(np.fft.fft2(heights - heights.mean())) ** 2 / points**4 * (side / (2 * np.pi)) ** 2
    index = np.fft.fftfreq(points, 1 / points)
    radius = np.hypot(*np.meshgrid(index, index))
    rings = np.round(4 * np.log2(np.maximum(radius, 1))).astype(int)
    inside = (radius >= 1) & (radius <= points / 2)
    count = np.bincount(rings[inside])
    mean = np.bincount(rings[inside], power[inside]) / np.maximum(count, 1)
    wavenumber = 2 * np.pi / side * np.bincount(rings[inside], radius[inside]) / np.maximum(count, 1)
    shown = (count > 0) & (mean > 1e-14 * mean.max())
    ax.loglog(wavenumber[shown], mean[shown], "o-", color=PALETTE[0], ms=4)
    ax.set(xlabel="q [1/m]", ylabel="C [m$^4$], ∫C d²q = $h_{rms}^2$", title=name)
    return ax
