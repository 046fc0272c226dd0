"""Makes src/store/start.h5, from which every surface file begins.

    python start.py FILE

It has no objects, stores no times, and its root has one attribute: a null-terminated string of 16 bytes.
"""

import sys

import numpy
from h5py import h5a, h5f, h5g, h5p, h5s, h5t

create = h5p.create(h5p.FILE_CREATE)
create.set_obj_track_times(False)
access = h5p.create(h5p.FILE_ACCESS)
access.set_libver_bounds(h5f.LIBVER_V110, h5f.LIBVER_V110)
kind = h5t.C_S1.copy()
kind.set_size(16)
file = h5f.create(sys.argv[1].encode(), h5f.ACC_TRUNC, create, access)
attribute = h5a.create(h5g.open(file, b"/"), b"CLASS", kind, h5s.create(h5s.SCALAR))
attribute.write(numpy.array(b"DIMENSION_SCALE", dtype="S16"), mtype=kind)
attribute.close()
file.close()
