"""Python values as TOML."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import Any

import numpy as np


def value(x: Any) -> str:
    """Returns `x` as a TOML value: numbers, truth values, strings, sequences and mappings."""
    if isinstance(x, (bool, np.bool_)):
        return "true" if x else "false"
    if isinstance(x, str):
        # JSON strings without escaped surrogates are TOML strings.
        return json.dumps(x, ensure_ascii=False)
    if isinstance(x, (int, np.integer)):
        return str(int(x))
    if isinstance(x, (float, np.floating)):
        number = float(x)
        if math.isnan(number):
            return "nan"
        if math.isinf(number):
            return "inf" if number > 0 else "-inf"
        return repr(number)
    if isinstance(x, np.ndarray):
        return value(x.tolist())
    if isinstance(x, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {value(v)}" for k, v in x.items()) + " }"
    if isinstance(x, (list, tuple)):
        return "[" + ", ".join(value(item) for item in x) + "]"
    raise TypeError(f"{type(x).__name__} has no form in TOML: use numbers, strings, lists and dictionaries")


def section(x: Mapping[str, Any]) -> str:
    """Returns `x` as the lines of a TOML section."""
    if not isinstance(x, Mapping):
        raise TypeError(f"{type(x).__name__} is no dictionary of keys and values")
    return "\n".join(f"{_key(k)} = {value(v)}" for k, v in x.items())


def _key(name: object) -> str:
    if not isinstance(name, str):
        raise TypeError(f"the key {name!r} is no string")
    plain = name.replace("_", "").replace("-", "")
    return name if plain.isascii() and plain.isalnum() else json.dumps(name, ensure_ascii=False)
