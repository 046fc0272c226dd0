"""Broadcasting of arguments to the columns of the extension module, and back."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Column: TypeAlias = NDArray[np.float64]
#: Argument of a function: a number, or anything that NumPy converts to an array of real numbers.
Reals: TypeAlias = ArrayLike
#: Result of a function: a `float` for scalar arguments, otherwise an `NDArray[np.float64]` of the broadcast shape. As for NumPy functions, the
#: argument types do not determine which of the two.
Result: TypeAlias = Any

SLIPS = ("eq8", "eq9", "a2", "a3")


def slips(as_printed: Collection[str]) -> frozenset[str]:
    """Uncorrected equations of the paper, by their names in `model.as_printed` of a spec."""
    words = frozenset([as_printed] if isinstance(as_printed, str) else as_printed)
    for word in sorted(words - frozenset(SLIPS)):
        raise ValueError(f"unknown equation {word!r} in as_printed\nhelp: use one of {', '.join(SLIPS)}")
    return words


def real(value: Any, kinds: str = "fiubO") -> NDArray[np.float64]:
    """An array of real numbers, NaN where a masked array is masked; `kinds` are the accepted kinds of `numpy.dtype`."""
    array = value if isinstance(value, np.ma.MaskedArray) else np.asarray(value)
    # Complex numbers, dates and text have no real value. Objects are converted: a missing value is NaN.
    if array.dtype.kind not in kinds:
        raise TypeError(f"cannot compute with an array of type {array.dtype}\nhelp: use real numbers")
    if isinstance(array, np.ma.MaskedArray):
        # Objects below a mask may be no numbers.
        plain = np.ma.filled(array, 0) if array.dtype.kind == "O" else array.data
        return np.where(np.ma.getmaskarray(array), np.nan, np.asarray(plain, dtype=np.float64))
    return np.asarray(array, dtype=np.float64)


def many(kernel: Callable[..., Collection[Column]], *values: Reals, **flags: bool) -> tuple[Result, ...]:
    """Calls a kernel with several result columns once for all elements."""
    arrays = [real(value) for value in values]
    shape = np.broadcast_shapes(*(array.shape for array in arrays))
    size = int(np.prod(shape, dtype=np.int64))
    # Scalars remain scalars.
    columns = [
        array.reshape(1) if array.size == 1 and size > 0 else np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1) for array in arrays
    ]
    results = kernel(*columns, **flags)
    return tuple(float(result[0]) if shape == () else result.reshape(shape) for result in results)


def one(kernel: Callable[..., Column], *values: Reals, **flags: bool) -> Result:
    """Calls a kernel with one result column once for all elements."""
    return many(lambda *columns, **told: (kernel(*columns, **told),), *values, **flags)[0]
