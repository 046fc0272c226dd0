"""Broadcasting: from what a user passes to the columns that the extension module takes, and back."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Column: TypeAlias = NDArray[np.float64]
#: What a function takes: a number, or anything that NumPy makes an array of real numbers of.
Reals: TypeAlias = ArrayLike
#: What a function gives: a `float` of numbers alone, else an `NDArray[np.float64]` of the broadcast shape. As with NumPy's own functions, which of
#: the two cannot be told from the types of the arguments.
Result: TypeAlias = Any

SLIPS = ("eq8", "eq9", "a2", "a3")


def slips(as_printed: Collection[str]) -> frozenset[str]:
    """The slips of the paper that are put back, by the words that a spec has for them in `model.as_printed`."""
    words = frozenset([as_printed] if isinstance(as_printed, str) else as_printed)
    for word in sorted(words - frozenset(SLIPS)):
        raise ValueError(f"cannot put back the slip {word!r}; allowed: {', '.join(SLIPS)}")
    return words


def _real(value: Reals) -> NDArray[np.float64]:
    array = np.asarray(value)
    # A complex number, a date or a text would lose its meaning, and not only digits. Objects are tried: a missing value is NaN.
    if array.dtype.kind not in "fiubO":
        raise TypeError(f"cannot compute with an array of type {array.dtype}; allowed: real numbers")
    return np.asarray(array, dtype=np.float64)


def many(kernel: Callable[..., Collection[Column]], *values: Reals, **flags: bool) -> tuple[Result, ...]:
    """Calls a kernel that gives several columns, once for all elements."""
    arrays = [_real(value) for value in values]
    shape = np.broadcast_shapes(*(array.shape for array in arrays))
    size = int(np.prod(shape, dtype=np.int64))
    # What is one number for all elements stays one.
    columns = [
        array.reshape(1) if array.size == 1 and size > 0 else np.ascontiguousarray(np.broadcast_to(array, shape)).reshape(-1) for array in arrays
    ]
    results = kernel(*columns, **flags)
    return tuple(float(result[0]) if shape == () else result.reshape(shape) for result in results)


def one(kernel: Callable[..., Column], *values: Reals, **flags: bool) -> Result:
    """Calls a kernel that gives one column, once for all elements."""
    return many(lambda *columns, **told: (kernel(*columns, **told),), *values, **flags)[0]
