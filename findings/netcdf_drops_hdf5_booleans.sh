#!/bin/bash
# netCDF4 1.7.5.1 and xarray 2026.9.0 (PyPI), file of h5py 3.16.0: attributes that are HDF5 booleans disappear, or stop `to_netcdf`.
#
# h5py stores `True` as an enumeration of 8-bit integers, as the crate hdf5-metno does. netCDF4 lists the other attributes of the
# file and not this one, without a warning. xarray's engine "netcdf4" follows. Its engine "h5netcdf" reads the value, as numpy.bool,
# which its `to_netcdf` refuses for both formats.
#
# Output seen (28 November 2026):
#   netCDF4: ['length', 'number']
#   xarray, netcdf4: ['length', 'number']
#   xarray, h5netcdf: ['length', 'number', 'truth']
#   to_netcdf: TypeError: Invalid value for attr 'truth': np.True_. For serialization to netCDF files, …
#
# Why it matters here: `periodic` decides how a surface is continued. A copy of a surface through xarray lost it, or could not be
# written. Truth values in HDF5 files are the integers 0 and 1 for that reason.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q h5py==3.16.0 netCDF4==1.7.5.1 h5netcdf==1.8.2 xarray==2026.9.0
cd "$folder"
"$folder/venv/bin/python" - <<'PY'
import h5py, netCDF4, warnings, xarray

warnings.simplefilter("error")
with h5py.File("x.h5", "w") as file:
    file["h"] = [1.0, 2.0]
    file.attrs.update(length=1e-3, number=1, truth=True)
names = sorted(netCDF4.Dataset("x.h5").ncattrs())
print("netCDF4:", names)
assert names == ["length", "number"]
for engine, wanted in [("netcdf4", ["length", "number"]), ("h5netcdf", ["length", "number", "truth"])]:
    with xarray.open_dataset("x.h5", engine=engine, phony_dims="sort") if engine == "h5netcdf" else xarray.open_dataset("x.h5", engine=engine) as data:
        print(f"xarray, {engine}:", sorted(data.attrs))
        assert sorted(data.attrs) == wanted
        try:
            data.to_netcdf(f"{engine}.nc")
            assert engine == "netcdf4"
        except TypeError as error:
            print("to_netcdf: TypeError:", str(error)[:110])
            assert engine == "h5netcdf" and "truth" in str(error)
PY
