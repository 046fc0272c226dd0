#!/bin/sh
# A tamaas model that is written to a file and read again has Young's modulus 1 and Poisson's ratio 0, whatever it had before.
#
# Packages: tamaas 2.9.0, h5py 3.16.0, netCDF4 1.7.5.1, numpy 2.4.6 (PyPI).
# Behaviour: the dumpers for HDF5, NetCDF, NumPy and JSON write the fields, the shape and the size of the system, and no elastic constant.
# Their `read` returns a complete model with the same tractions and displacements. Its E, nu and E_star are the defaults of a new model.
# Everything computed from it uses these: displacements from the stored tractions, and the energy. No message is given.
# Output seen (November 2026):
#     model with E = 1e+06, nu = 0.5; E* = 1333333
#     HDF5    E = 1, nu = 0, E* = 1; amplitude of displacements from the stored tractions: 1333333.3 times the stored one
#     NumPy   E = 1, nu = 0, E* = 1; amplitude of displacements from the stored tractions: 1333333.3 times the stored one
#     NetCDF  E = 1, nu = 0, E* = 1; amplitude of displacements from the stored tractions: 1333333.3 times the stored one
#     JSON    E = 1, nu = 0, E* = 1; amplitude of displacements from the stored tractions: 1333333.3 times the stored one
# Why it matters: stored contacts are the usual input of a later analysis (elastic energy, stresses, a restart at a higher load). A loop
# that is continued from a file continues with another material. The constants have to be stored beside the file and set again.
#
# Exit code: 0 if the behaviour is as described, 1 if it has changed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet tamaas==2.9.0 h5py==3.16.0 netCDF4==1.7.5.1 numpy==2.4.6
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import sys

import numpy
import tamaas
from tamaas.dumpers import H5Dumper, JSONDumper, NetCDFDumper, NumpyDumper

tamaas.set_log_level(tamaas.LogLevel.error)
points = 32
x = numpy.arange(points) / points
model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [2.0, 2.0], [points, points])
model.E, model.nu = 1e6, 0.5
model.traction[...] = 1e3 * (1 + numpy.cos(2 * numpy.pi * x)[:, None] * numpy.ones(points))
model.solveNeumann()
print(f"model with E = {model.E:g}, nu = {model.nu:g}; E* = {model.E_star:.0f}")
fields = ("traction", "displacement")
H5Dumper("a", *fields) << model
NumpyDumper("a", *fields) << model
NetCDFDumper("a", *fields) << model
JSONDumper("a.json") << model
good = True
for name, dumper, path in [("HDF5", H5Dumper, "hdf5/a_0000.h5"), ("NumPy", NumpyDumper, "numpys/a_0000.npz"),
                           ("NetCDF", NetCDFDumper, "netcdf/a.nc"), ("JSON", JSONDumper, "a.json")]:
    again = dumper.read(path)
    stored = numpy.array(again.displacement)
    good &= numpy.allclose(stored.ravel(), numpy.array(model.displacement).ravel(), rtol=1e-12)
    again.solveNeumann()
    ratio = numpy.ptp(numpy.array(again.displacement)) / numpy.ptp(stored)
    print(f"{name:7s} E = {again.E:g}, nu = {again.nu:g}, E* = {again.E_star:g}; "
          f"amplitude of displacements from the stored tractions: {ratio:.1f} times the stored one")
    good &= (again.E, again.nu) == (1, 0) and abs(ratio / model.E_star - 1) < 1e-6
sys.exit(0 if good else "the behaviour has changed")
PY
echo "as described"
