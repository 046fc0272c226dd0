"""Conversion of a nested dict to TOML."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def dumps(table: Mapping[str, Any]) -> str:
    """TOML text of a table. Keys with the value None are omitted, since TOML has no null; NumPy numbers and arrays are converted."""
    return "\n".join(_lines(table, ())) + "\n"


def _lines(table: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    values = {key: _plain(value) for key, value in table.items() if value is not None}
    nested = {key: value for key, value in values.items() if isinstance(value, dict)}
    rows = {key: value for key, value in values.items() if _is_rows(value)}
    for key, value in values.items():
        if key not in nested and key not in rows:
            yield f"{_key(key)} = {_value(value, (*path, key))}"
    for key, value in nested.items():
        yield f"\n[{_dotted((*path, key))}]"
        yield from _lines(value, (*path, key))
    for key, value in rows.items():
        for row in value:
            yield f"\n[[{_dotted((*path, key))}]]"
            yield from _lines(row, (*path, key))


def _is_rows(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(row, dict) for row in value)


def _plain(value: Any) -> Any:
    """Values of NumPy and of other mappings and sequences as built-in types."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    if isinstance(value, (list, tuple)):
        return [_plain(element) for element in value]
    return value


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise TypeError(f"cannot write the key {key!r} as TOML\nhelp: use a str")
    return key if _BARE.fullmatch(key) else _text(key)


def _dotted(path: tuple[str, ...]) -> str:
    return ".".join(_key(key) for key in path)


def _text(text: str) -> str:
    # The escapes of JSON are valid TOML, except for DEL, which JSON does not escape.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any, path: tuple[str, ...]) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, list):
        return "[" + ", ".join(_value(_plain(element), path) for element in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {_value(_plain(entry), (*path, key))}" for key, entry in value.items()) + " }"
    raise TypeError(f"cannot write {'.'.join(path)} as TOML: it is of type {type(value).__name__}\nhelp: use bool, int, float, str, lists and dicts")
