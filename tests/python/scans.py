"""Scans as Python writes them, and exported surfaces as Python reads them.

    python scans.py make DIR     writes files, and says what is in them in DIR/manifest.tsv and DIR/*.f64
    python scans.py check FILE   reads an exported NetCDF file, and compares it with FILE.f64 and FILE.tsv
    python scans.py tamaas FILE  the same of a file for Tamaas

The first difference ends it.
"""

import sys
from pathlib import Path

import netCDF4
import numpy
from SurfaceTopography import Topography, read_topography
from SurfaceTopography.IO import NCReader
from tamaas.dumpers import H5Dumper

KINDS = ["f4", "f8", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8"]
NOTHING = "-"


class Folder:
    """Files, and what is in them."""

    def __init__(self, path):
        self.path = Path(path)
        self.path.mkdir(parents=True, exist_ok=True)
        self.lines = []

    def __truediv__(self, name):
        return str(self.path / name)

    def says(self, name, kind, heights, size=None, unit=None, periodic=None, exact=True):
        """Rows by columns of heights, as Rust is to find them."""
        heights = numpy.asarray(numpy.ma.filled(heights, numpy.nan), dtype="<f8")
        (self.path / f"{name}.f64").write_bytes(heights.tobytes())
        words = [name, kind, *heights.shape, *(size or [NOTHING] * 2), unit or NOTHING]
        words += [NOTHING if periodic is None else int(periodic), "exact" if exact else "close"]
        self.lines.append("\t".join(str(word) for word in words))

    def close(self):
        (self.path / "manifest.tsv").write_text("\n".join(self.lines) + "\n", encoding="utf-8")


def arrays(folder, random):
    """NumPy's own files."""
    for kind in KINDS:
        for sign in "<>":
            for order in "CF":
                name = f"{kind}{'be' if sign == '>' else 'le'}{order}.npy"
                array = (random.normal(size=(5, 7)) * 60).astype(sign + kind, order=order)
                numpy.save(folder / name, array)
                folder.says(name, "npy", array.T)
    array = random.normal(size=(3, 4))
    for version in [(1, 0), (2, 0), (3, 0)]:
        name = f"version{version[0]}.npy"
        with open(folder / name, "wb") as file:
            numpy.lib.format.write_array(file, array, version=version)
        folder.says(name, "npy", array.T)


def surfaces(folder, random):
    """What SurfaceTopography writes."""
    plain = random.normal(size=(6, 9))
    missing = numpy.ma.masked_array(plain.copy(), mask=random.random((6, 9)) < 0.2)
    for unit, metres in [("m", 1.0), ("µm", 1e-6), ("nm", 1e-9), ("mm", 1e-3), ("Å", 1e-10), ("pm", 1e-12), (None, 1.0)]:
        for label, heights in [("whole", plain), ("missing", missing)]:
            surface = Topography(heights, (3.0, 4.5), unit=unit, periodic=label == "whole")
            size = None if unit is None else [3.0 * metres, 4.5 * metres]
            for form in ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET"]:
                name = f"{label}-{unit}-{form}.nc"
                surface.to_netcdf(folder / name, format=form)
                ascii_unit = {"µm": "um", "Å": "A"}.get(unit, unit)
                folder.says(name, "nc", heights * metres, size, ascii_unit, label == "whole")
            name = f"{label}-{unit}.txt"
            surface.to_matrix(folder / name)
            folder.says(name, "txt", numpy.ma.filled(heights, numpy.nan) * metres, size, unit)
            if unit is None:
                continue
            for kind in "DFLI":
                name = f"{label}-{unit}-{kind}.x3p"
                surface.to_x3p(folder / name, dtype=kind)
                # SurfaceTopography masks only what the file marks; in doubles and floats NaN stands for it.
                read = read_topography(folder / name)
                folder.says(name, "x3p", read.heights(), [float(side) for side in read.physical_sizes], "m", exact=kind in "DF")


def newer(folder, random):
    """CDF-5, records, and kinds of numbers that SurfaceTopography does not write."""
    heights = random.integers(-9, 9, size=(4, 3))
    for kind in ["i1", "i2", "i4", "f4", "f8", "u1", "u2", "u4", "i8", "u8"]:
        for first in [4, None]:
            name = f"cdf5-{kind}-{'records' if first is None else 'fixed'}.nc"
            with netCDF4.Dataset(folder / name, "w", format="NETCDF3_64BIT_DATA") as file:
                file.createDimension("x", first)
                file.createDimension("y", 3)
                file.createVariable("other", "i1", ("x",))[:] = numpy.arange(4)
                array = numpy.abs(heights).astype(kind)
                file.createVariable("heights", kind, ("x", "y"))[:] = array
            folder.says(name, "nc", array)


def texts(folder, random):
    """What numpy.savetxt writes."""
    heights = random.normal(size=(6, 4))
    heights[2, 1] = numpy.nan
    for label, sign in [("space", " "), ("tab", "\t"), ("comma", ","), ("semicolon", ";")]:
        numpy.savetxt(folder / f"{label}.txt", heights, delimiter=sign, header="a remark")
        folder.says(f"{label}.txt", "txt", heights.T)


def check(path):
    """An exported file, by SurfaceTopography, scipy and the NetCDF library."""
    rows, columns, x, y, periodic = Path(f"{path}.tsv").read_text().split()
    expected = numpy.frombuffer(Path(f"{path}.f64").read_bytes(), dtype="<f8").reshape(int(rows), int(columns))
    surface = read_topography(path)
    assert isinstance(surface.heights(), numpy.ndarray) and not surface.has_undefined_data
    assert numpy.array_equal(surface.heights(), expected)
    assert tuple(surface.physical_sizes) == (float(x), float(y)), surface.physical_sizes
    assert surface.unit == "m" and surface.is_periodic == bool(int(periodic))
    assert NCReader(path).channels[0].unit == "m"
    with netCDF4.Dataset(path) as file:
        assert file.data_model == "NETCDF3_64BIT_OFFSET"
        assert numpy.array_equal(file["heights"][:], expected)
        assert numpy.array_equal(file["x"][:], numpy.arange(int(rows)) / int(rows) * float(x))
        assert file["y"].unit == file["heights"].unit == "m" and file["y"].length == float(y)
    print(f"{path}: {rows} by {columns} heights, equal to the last bit")


def tamaas(path):
    """An exported file, by Tamaas."""
    rows, columns, x, y = Path(f"{path}.tsv").read_text().split()
    expected = numpy.frombuffer(Path(f"{path}.f64").read_bytes(), dtype="<f8").reshape(int(rows), int(columns))
    model = H5Dumper.read(path)
    assert str(model.type) == "model_type.basic_2d"
    assert list(model.system_size) == [float(x), float(y)], model.system_size
    assert list(model.global_shape) == list(expected.shape)
    assert numpy.array_equal(model["surface"], expected)
    print(f"{path}: {rows} by {columns} heights, equal to the last bit")


def main(verb, path):
    if verb != "make":
        return {"check": check, "tamaas": tamaas}[verb](path)
    folder, random = Folder(path), numpy.random.default_rng(7)
    for make in [arrays, surfaces, newer, texts]:
        make(folder, random)
    folder.close()
    print(f"{len(folder.lines)} files")


if __name__ == "__main__":
    main(*sys.argv[1:])
