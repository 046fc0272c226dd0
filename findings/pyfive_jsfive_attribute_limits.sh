#!/bin/bash
# pyfive 1.3.0 (PyPI) and jsfive 0.4.2 (npm): options of the HDF5 library that close a valid file to readers without it.
#
# Files of h5py 3.16.0 with one 40 x 40 dataset; netCDF, h5wasm and h5py itself read all of them.
# 1. `attr_phase_change(64, 0)` on the root, which keeps attributes in the object header: pyfive ends with a bare AssertionError,
#    jsfive with "TypeError: thing is not a function", when the dataset is read, even with five attributes.
# 2. Chunks of format 1.10 (layout message 4): pyfive "cannot yet read HDF5 files with layout class 4", jsfive the TypeError.
#    Chunks of format 1.8 and contiguous values are read.
# 3. More than eight attributes (dense storage): pyfive reads them; jsfive shows none, without a message.
#
# Output seen (28 November 2026):
#   file             pyfive                        jsfive
#   phase change     AssertionError                TypeError
#   chunks of 1.10   RuntimeError                  TypeError
#   16 attributes    values right, 16 attributes   values right, 0 attributes
#   4 attributes     values right, 4 attributes    values right, 4 attributes
#
# Why it matters here: surfaces have 16 attributes and must be readable in a browser and without compiled code. Heights are
# contiguous, maps have chunks of format 1.8, and attributes the usual limits, for that reason.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q h5py==3.16.0 pyfive==1.3.0
cd "$folder"
npm init -y >/dev/null
npm install --silent jsfive@0.4.2 >/dev/null
cat > make.py <<'PY'
import numpy, h5py
from h5py import h5f, h5p


def make(name, count, phase=False, chunks=None):
    access, create = h5p.create(h5p.FILE_ACCESS), h5p.create(h5p.FILE_CREATE)
    access.set_libver_bounds(h5f.LIBVER_V110, h5f.LIBVER_V110)
    if phase:
        create.set_attr_phase_change(64, 0)
    with h5py.File(h5f.create(name.encode(), h5f.ACC_TRUNC, create, access)) as file:
        for k in range(count):
            file.attrs[f"a{k}"] = float(k)
        file.create_dataset("h", data=numpy.arange(1600.0).reshape(40, 40), chunks=chunks)


make("phase change.h5", 4, phase=True)
make("chunks of 1.10.h5", 4, chunks=(16, 16))
make("16 attributes.h5", 16)
make("4 attributes.h5", 4)
PY
cat > read.py <<'PY'
import numpy, pyfive, sys

try:
    file = pyfive.File(sys.argv[1])
    right = numpy.array_equal(file["h"][:], numpy.arange(1600.0).reshape(40, 40))
    print(f"values {'right' if right else 'wrong'}, {len(file.attrs)} attributes")
except Exception as error:
    print(type(error).__name__)
PY
cat > read.mjs <<'JS'
import * as jsfive from 'jsfive';
import fs from 'fs';
try {
    const bytes = fs.readFileSync(process.argv[2]);
    const file = new jsfive.File(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), 'x.h5');
    const right = file.get('h').value.every((value, k) => value === k);
    console.log(`values ${right ? 'right' : 'wrong'}, ${Object.keys(file.attrs).length} attributes`);
} catch (error) {
    console.log(error.constructor.name);
}
JS
"$folder/venv/bin/python" make.py
found=$(for name in "phase change" "chunks of 1.10" "16 attributes" "4 attributes"; do
    printf '%s|%s|%s\n' "$name" "$("$folder/venv/bin/python" read.py "$name.h5")" "$(node read.mjs "$name.h5")"
done)
echo "$found"
test "$found" = "phase change|AssertionError|TypeError
chunks of 1.10|RuntimeError|TypeError
16 attributes|values right, 16 attributes|values right, 0 attributes
4 attributes|values right, 4 attributes|values right, 4 attributes"
