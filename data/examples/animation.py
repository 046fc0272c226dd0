"""A loop and its contact map as an animation: the second figure of the README.

    python data/examples/animation.py RUN [FIGURE]

RUN is the output folder of a finished run with `contacts = "all"`, FIGURE the animated SVG to write (default: film.svg).
Needs numpy and pyarrow.
"""

import pathlib
import sys

import numpy as np
import pyarrow.parquet as pq

FRAMES, SECONDS, SIDE = 50, 8, 260

run = pathlib.Path(sys.argv[1])
figure = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "film.svg")

cycle = pq.read_table(run / "statistics/cycles.parquet").to_pylist()[0]
folder = run / "cycles" / cycle["cycle_id"]
steps = pq.read_table(folder / "steps.parquet").select(["step", "branch", "penetration", "load"]).to_pylist()
contacts = pq.read_table(folder / "contacts.parquet").to_pylist()
length = cycle["length_m"]

penetration, load = (np.array([step[name] for step in steps]) for name in ("penetration", "load"))
at_x = np.interp(penetration, [penetration.min(), penetration.max()], [50, 300])
at_y = np.interp(load, [load.min(), load.max()], [20 + SIDE, 20])
kept = range(0, len(steps), max(1, len(steps) // FRAMES))
times = ";".join(f"{k / len(kept):.4f}" for k in range(len(kept)))


def animated(attribute, values):
    """An animation that jumps from value to value."""
    timing = f'keyTimes="{times}" dur="{SECONDS}s" calcMode="discrete" repeatCount="indefinite"'
    return f'<animate attributeName="{attribute}" values="{";".join(values)}" {timing}/>'


def path(branch, dash):
    """A branch of the loop."""
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y, step in zip(at_x, at_y, steps, strict=True) if step["branch"] == branch)
    return f'<polyline points="{points}" fill="none" stroke="#7b3294" stroke-width="2" stroke-dasharray="{dash}"/>'


def spots(k):
    """The contact spots of a step."""
    circles = ""
    for spot in contacts:
        if spot["step"] == steps[k]["step"] and spot["state"] == "contact":
            x, y = (spot[name] / length * SIDE for name in ("centroid_x_m", "centroid_y_m"))
            colour = "#c0281c" if spot["load_n"] < 0 else "#0072b2"
            circles += f'<circle cx="{x:.1f}" cy="{SIDE - y:.1f}" r="{spot["contact_radius_m"] / length * SIDE:.1f}" fill="{colour}"/>'
    return circles


# Shown where nothing is animated: the step with the largest load.
still = max(kept, key=lambda k: load[k])
zero = np.interp(0, [load.min(), load.max()], [20 + SIDE, 20])
svg = f"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 620 320" width="620" height="320" font-family="sans-serif" font-size="14" role="img"
aria-label="Load against mean penetration of one cycle, and its contact spots, step by step">
<rect width="620" height="320" fill="white"/><path d="M50 {zero:.1f}H300" stroke="#999"/><rect x="40" y="10" width="270" height="{SIDE + 20}" fill="none" stroke="black"/>
<text x="175" y="310" text-anchor="middle">mean penetration Δ</text><text transform="translate(26 150) rotate(-90)" text-anchor="middle">load F</text>
{path("loading", "7 4")}{path("unloading", "none")}
<circle r="6" cx="{at_x[still]:.1f}" cy="{at_y[still]:.1f}" fill="black">{animated("cx", [f"{at_x[k]:.1f}" for k in kept])}{animated("cy", [f"{at_y[k]:.1f}" for k in kept])}</circle>
<svg x="340" y="20" width="{SIDE}" height="{SIDE}"><rect width="{SIDE}" height="{SIDE}" fill="#eee"/>
"""
for frame, k in enumerate(kept):
    visible = ["visible" if frame == other else "hidden" for other in range(len(kept))]
    svg += f'<g fill-opacity="0.85" visibility="{"visible" if k == still else "hidden"}">{spots(k)}{animated("visibility", visible)}</g>\n'
svg += f"""</svg><rect x="340" y="20" width="{SIDE}" height="{SIDE}" fill="none" stroke="black"/>
<g font-size="12"><circle cx="350" cy="304" r="6" fill="#0072b2"/><text x="361" y="308">compressive</text>
<circle cx="454" cy="304" r="6" fill="#c0281c"/><text x="465" y="308">tensile</text><text x="600" y="308" text-anchor="end">side {1e3 * length:.3g} mm</text></g></svg>
"""
figure.write_text(svg, encoding="utf-8")
