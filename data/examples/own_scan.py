# %% [markdown]
# From a scan to the hysteresis curve of its contact. The cells of this script open as a notebook in Jupyter (jupytext) and VS Code.
#
#     pip install . matplotlib && cargo install --path .
#     python data/examples/own_scan.py my_scan.x3p --figure curve.png --modulus 1e8
#
# Without a file it uses a surface that it generates. --pixel-m, --unit and --dataset give what is missing in a file.

# %%
import argparse
import re
from pathlib import Path

import matplotlib
import numpy as np

import hysteron

matplotlib.use("Agg")
import matplotlib.pyplot as plt

parser = argparse.ArgumentParser()
parser.add_argument("scan", nargs="?", type=Path)
parser.add_argument("--figure", type=Path, default=Path("own_scan.png"))
parser.add_argument("--pixel-m", type=float)
parser.add_argument("--unit")
parser.add_argument("--dataset")
parser.add_argument("--fill", action="store_true", help="interpolate missing points")
parser.add_argument("--modulus", type=float, help="reduced modulus E* [Pa]")
parser.add_argument("--adhesion", type=float, default=0.05, help="work of adhesion [J/m²]")
options = parser.parse_args()  # in a notebook: parse_args(["my_scan.x3p"])
scan, given = options.scan, {"pixel_m": options.pixel_m, "unit": options.unit, "dataset": options.dataset, "fill": options.fill}
if scan is None:
    scan = Path("made_up.npy")
    # A rough, non-periodic square of 128 x 128 points, 50 nm apart, with a tilt; heights in nanometres.
    random = np.random.default_rng(1)
    q = np.hypot(*np.meshgrid(np.fft.fftfreq(256), np.fft.rfftfreq(256), indexing="ij"))
    modes = np.where((q > 0) & (q < 1 / 8), np.maximum(q, 1 / 256) ** -1.8, 0) * np.exp(2j * np.pi * random.random(q.shape))
    heights = np.fft.irfft2(modes, s=(256, 256))[:128, :128]
    np.save(scan, 20 * heights / heights.std() + 0.3 * np.arange(128)[:, None])
    # A .npy file has no pixel size and no unit; X3P and NetCDF files have both.
    given |= {"pixel_m": 50e-9, "unit": "nm"}

# %% Statistics of the surface: moments, spectrum, and a fit of a self-affine spectrum.
figure = options.figure
surface = figure.with_suffix(".surface.h5")
about = hysteron.take(scan, surface, **given)
fit = about["self_affine"]
print(f"{about['point_count']} points, {about['length_m']:.3e} m: rms height {about['rms_height_m']:.3e} m, rms slope {about['rms_slope']:.3f}")
print(f"H = {fit['hurst']:.2f} with a scatter of {fit['scatter']:.2f} decades; {about['summit_count']} summits" if fit else "no fit")

# %% Contact with an elastic half-space: an isolated patch, since the scan is not periodic. Finished tasks are kept.
# Default of the modulus: flattening the roughness costs at most E* h_rms h'_rms/4 per area, and contact releases Δγ. Much softer solids are in full contact,
# and for much stiffer ones JKR theory does not hold.
modulus = options.modulus or float(f"{3 * options.adhesion / (about['rms_slope'] * about['rms_height_m']):.1e}")
run = hysteron.run(
    {
        "name": re.sub(r"[^A-Za-z0-9_-]+", "_", figure.stem),
        "surface": {"file": str(surface)},
        "material": {"contact_modulus_pa": modulus, "work_of_adhesion_j_m2": options.adhesion},
        "model": {"boundary": "isolated"},
        "cycle": {"max_load": [0.004]},
    },
    out=figure.with_suffix(""),
)

# %% The hysteresis loop, and the spectrum with its fit.
if not run.cycle_ids:
    raise SystemExit("the cycle failed; the message of the program above gives the reason")
table = run.steps(run.cycle_ids[0])
steps = {name: table[name].to_numpy() for name in ("branch", "penetration", "load")}
left, right = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")[1]
for branch, style, colour in [("loading", "--", "#008a5e"), ("unloading", "-", "#cc3311")]:
    some = steps["branch"] == branch
    left.plot(steps["penetration"][some], steps["load"][some], style, color=colour, label=branch)
left.axhline(0, color="grey", lw=0.5)
case = run.cases.to_pylist()[0]
left.set(xlabel="Δ/h_rms", ylabel="F/(E* A₀)", title=f"Θ = {case['loss_mean']:.2e} E* A₀ h_rms")
left.legend()
q, density = np.array([(ring["wavenumber_1_m"], ring["density_m4"]) for ring in about["spectrum"]]).T
right.loglog(q, density, "o", ms=3, color="#cc3311", label="scan")
if fit:
    line = fit["plateau_m4"] * np.maximum(q / fit["roll_off_1_m"], 1.0) ** (-2 * (fit["hurst"] + 1))
    right.loglog(q, line, "--", color="#0077bb", label=f"self-affine, H = {fit['hurst']:.2f}")
right.axvline(2 * np.pi / about["shortest_wavelength_m"], color="grey", lw=0.5)
right.set(xlabel="q [1/m]", ylabel="C(q) [m⁴]")
right.legend()
plt.savefig(figure, dpi=150)
print(f"{figure}: E* = {modulus:.1e} Pa, A/A0 = {case['area_at_max_load_mean']:.2f} at F/(E* A0) = 0.004")
if case["caution"]:
    print(f"warnings: {case['caution'].replace('+', ', ')}; {run.dir / 'report.html'} explains them")
