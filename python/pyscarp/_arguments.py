# SPDX-License-Identifier: MIT
"""Checks of arguments: each returns what the library takes, or throws one line that names the argument."""

from __future__ import annotations

from typing import Any, Callable, Optional

import numpy as np

from ._core import Error


def shown(value: Any) -> str:
    """Returns a value as text for a message: one line, not too long."""
    words = " ".join(repr(value).split())
    return words if len(words) <= 60 else f"{words[:57]}..."


def number(value: Any, name: str) -> float:
    """Returns a float; throws TypeError for anything but a number."""
    try:
        if not isinstance(value, (str, bytes)):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise TypeError(f"{name}: {shown(value)} is not a number (give a number)")


def numbers(values: Any, count: int, name: str, meaning: str) -> tuple[float, ...]:
    """Returns that many floats; throws TypeError for anything else."""
    try:
        found = tuple(number(v, name) for v in values)
    except TypeError:
        raise TypeError(f"{name}: {shown(values)} (expected {meaning})") from None
    if len(found) != count:
        raise TypeError(f"{name}: {len(found)} numbers (expected {meaning})")
    return found


def whole(value: Any, name: str, least: int = -(2**31), most: int = 2**31 - 1) -> int:
    """Returns an int; throws TypeError for anything but a number, Error for a fraction or one out of range."""
    found = number(value, name)
    if not (found == np.rint(found) and least <= found <= most):
        raise Error(f"{name}: {shown(value)} (expected a whole number from {least} to {most})")
    return int(value)


def flag(value: Any, name: str) -> bool:
    """Returns a bool; throws TypeError for anything but True and False, or 1 and 0."""
    if isinstance(value, (bool, np.bool_, int)) and value in (False, True):
        return bool(value)
    raise TypeError(f"{name}: {shown(value)} is not True or False (give one of them)")


def text(value: Any, name: str) -> str:
    """Returns a str of one line; throws TypeError for anything else."""
    if isinstance(value, str) and len(value.splitlines()) <= 1:
        return value
    raise TypeError(f"{name}: {shown(value)} is not a name (give text of one line)")


def array_of_numbers(values: Any, name: str) -> np.ndarray:
    """Returns an array of real numbers of any type; throws TypeError for other things and hidden elements."""
    if isinstance(values, np.ma.MaskedArray) and np.ma.is_masked(values):
        raise TypeError(f"{name}: a masked array hides some of its elements (fill it first: .filled(value))")
    try:
        array = np.asarray(values)
    except ValueError:  # lists of different lengths
        raise TypeError(f"{name}: {shown(values)} is not an array (give rows of the same length)") from None
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name}: {shown(values)} is not an array of numbers (convert it to numbers)")
    return array


def whole_numbers(values: Any, name: str) -> np.ndarray:
    """Returns an array of int64; numbers beyond its range become its ends. Throws Error for fractions and NaN, else as
    `array_of_numbers`."""
    array = array_of_numbers(values, name)
    if array.dtype.kind == "f":
        wrong = ~(array == np.rint(array))
        if wrong.any():
            raise Error(f"{name}: {array[wrong].flat[0]} is not a whole number (round the array: numpy.rint)")
        array = np.clip(array.astype(float), -(2.0**62), 2.0**62)
    elif array.dtype.kind == "u":
        array = np.minimum(array, np.iinfo(np.int64).max)
    return array.astype(np.int64)


def converted(values: Any, dtype: np.dtype, name: str, remedy: str = "") -> np.ndarray:
    """Returns an array of another type with the same values; floats are rounded to shorter floats. Throws Error for a
    value that an integer type does not have, else as `array_of_numbers`."""
    array = array_of_numbers(values, name)
    if dtype.kind in "iu":
        ends = np.iinfo(dtype)
        wrong = ~((array >= ends.min) & (array <= ends.max))
        if array.dtype.kind == "f":
            wrong |= array != np.rint(array)
        if wrong.any():
            raise Error(
                f"{name}: {array[wrong].flat[0]} is not a value of {dtype} (expected whole numbers from {ends.min} to "
                f"{ends.max}{remedy})"
            )
    with np.errstate(over="ignore"):  # infinity is reported where infinities are
        return array.astype(dtype)


def refuse_unused(function: Callable[..., Any], why: str, **given: Any) -> None:
    """Throws Error naming the arguments that the caller gave although they have no effect. Arguments equal to the
    default of the function count as not given."""
    defaults = function.__kwdefaults__ or {}
    unused = [name for name, value in given.items() if not _same(value, defaults[name])]
    if unused:
        raise Error(f"{', '.join(unused)}: no effect {why} (leave {'it' if len(unused) == 1 else 'them'} out)")


def _same(value: Any, default: Any) -> bool:
    return value is default or (default is not None and bool(np.array_equal(value, default)))


def optional(check: Callable[..., Any], value: Optional[Any], name: str) -> Optional[Any]:
    """Returns None for None, else the result of another check."""
    return None if value is None else check(value, name)
