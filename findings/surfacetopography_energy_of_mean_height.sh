#!/bin/sh
# The elastic energy, spectrum and filtered slope of a non-periodic map in SurfaceTopography depend on its mean height.
#
# Packages: SurfaceTopography 1.27.1 (PyPI), numpy 2.4.6.
# Behaviour: a non-periodic map is multiplied by a Hann window before every Fourier transform, and the mean is not subtracted first. A
# constant c added to all heights therefore adds c times the window, a smooth bump of the size of the map. elastic_energy (new in 2026),
# moment_power_spectrum, power_spectrum_from_area and rms_gradient(short_wavelength_cutoff=...) contain it. rms_gradient() without a
# cut-off and the estimate by autocorrelation do not. detrend("center") removes it. No message is given.
# Output seen (November 2026): rms height 9.3 nm, map of 2 um, E* = 1
#     mean height [um]   elastic energy   rms gradient with cut-off   without   energy by autocorrelation
#                    0         0.000410                      0.2372    0.2409                    0.000449
#                 0.01         0.000467                      0.2389    0.2409                    0.000449
#                  0.1         0.005564                      0.3595    0.2409                    0.000449
#                    1         0.510501                      2.6979    0.2409                    0.000449
#     after detrend("center"): 0.000410
# Why it matters: heights of an instrument count from an arbitrary origin, often micrometres away from a surface with nanometres of
# roughness. The elastic energy of full contact against the work of adhesion decides whether a surface is sticky. Here it is wrong by a
# factor of 1200. A filter that should remove something increases the slope ten times.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet SurfaceTopography==1.27.1 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys

from SurfaceTopography import Topography
from SurfaceTopography.Generation import fourier_synthesis

rough = fourier_synthesis((256, 256), (2.0, 2.0), hurst=0.8, rms_height=0.01, long_cutoff=0.5, short_cutoff=0.05, rng=1)
heights = rough.heights() - rough.heights().mean()
print(f"rms height {1e3 * heights.std():.1f} nm, map of 2 um, E* = 1")
print("mean height [um]   elastic energy   rms gradient with cut-off   without   energy by autocorrelation")
found = {}
for mean in (0, 0.01, 0.1, 1):
    scan = Topography(heights + mean, (2.0, 2.0), unit="µm")
    found[mean] = (scan.elastic_energy(1.0), scan.rms_gradient(short_wavelength_cutoff=0.02), scan.rms_gradient(),
                   scan.variance_half_derivative_via_autocorrelation_from_area() / 4)
    energy, filtered, gradient, other = found[mean]
    print(f"{mean:16g} {energy:16.6f} {filtered:27.4f} {gradient:9.4f} {other:27.6f}")
centred = Topography(heights + 1, (2.0, 2.0), unit="µm").detrend("center").elastic_energy(1.0)
print(f'after detrend("center"): {centred:.6f}')
good = (
    found[1][0] > 1000 * found[0][0]
    and found[1][1] > 10 * found[0][1]
    and abs(found[1][2] / found[0][2] - 1) < 1e-6
    and abs(found[1][3] / found[0][3] - 1) < 1e-6
    and abs(centred / found[0][0] - 1) < 1e-6
)
sys.exit(0 if good else "the behaviour has changed")
PY
echo "as described"
