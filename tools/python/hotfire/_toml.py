# SPDX-License-Identifier: Apache-2.0
"""Model files from dictionaries. Debian's Python reads TOML and does not write it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np


def _value(value: Any, key: str) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=True)
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (Sequence, np.ndarray)):
        return "[" + ", ".join(_value(part, key) for part in value) + "]"
    raise TypeError(f"{key} = {value!r}: no value of a model file; allowed: a number, a text, a list of these, a table")


def _key(key: Any) -> str:
    if not isinstance(key, str):
        raise TypeError(f"{key!r}: keys of a model file are texts")
    return key if key.replace("_", "a").replace("-", "a").isalnum() and key.isascii() else json.dumps(key)


def _table(table: Mapping, prefix: str, lines: list) -> None:
    for key, value in table.items():
        if not isinstance(value, Mapping):
            lines.append(f"{_key(key)} = {_value(value, prefix + str(key))}")
    for key, value in table.items():
        if isinstance(value, Mapping):
            name = prefix + _key(key)
            lines.append(f"[{name}]")
            _table(value, name + ".", lines)


def text_of(table: Mapping) -> str:
    """The text of a model file with these keys. ``schema = 1`` is added where it is not given."""
    lines: list = []
    _table(table if "schema" in table else {"schema": 1, **table}, "", lines)
    return "\n".join(lines) + "\n"
