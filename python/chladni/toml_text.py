"""Keys set in Python as the text of a scene file."""

import math
import re
from collections.abc import Mapping
from numbers import Integral, Real
from typing import Any


def toml_text(table: Mapping[str, Any]) -> str:
    """The TOML text of a table: a line for each of its keys, tables of tables in their own sections.

    >>> print(toml_text({"name": "disc", "squeal": {"friction": 0.5, "pads": [{"stiffness": 6e6}]}}))
    name = "disc"
    <BLANKLINE>
    [squeal]
    friction = 0.5
    pads = [{ stiffness = 6000000.0 }]
    <BLANKLINE>
    """
    values = {key: value for key, value in table.items() if not isinstance(value, Mapping)}
    lines = [f"{_key(key)} = {_value(value)}\n" for key, value in values.items()]
    sections = [_section([key], table[key]) for key in table if key not in values]
    return "".join(lines + sections).lstrip("\n")


def _section(path: list[str], table: Mapping[str, Any]) -> str:
    lines = [f"{_key(key)} = {_value(value)}\n" for key, value in table.items()]
    return f"\n[{'.'.join(map(_key, path))}]\n" + "".join(lines)


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _text(key)


def _text(text: str) -> str:
    def escaped(character: str) -> str:
        if character in '"\\':
            return "\\" + character
        return character if character >= " " and character != "\x7f" else f"\\u{ord(character):04x}"

    return '"' + "".join(map(escaped, text)) + '"'


def _real(number: float) -> str:
    if math.isfinite(number):
        text = repr(number)
        return text if set(text) & set(".e") else text + ".0"
    return str(number)


def _value(value: Any) -> str:
    if isinstance(value, bool) or type(value).__name__ == "bool_":
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, Integral):
        return str(int(value))
    if isinstance(value, Real):
        return _real(float(value))
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {_value(item)}" for key, item in value.items()) + " }"
    try:
        return "[" + ", ".join(_value(item) for item in value) + "]"
    except TypeError:
        raise TypeError(f"{value!r} has no place in a scene: give numbers, texts, truth values, lists or dicts") from None
