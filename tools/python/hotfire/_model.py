# SPDX-License-Identifier: Apache-2.0
"""Models: what a TOML file or a dictionary declares."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional, Union

from . import _core
from ._toml import text_of


@dataclass(frozen=True)
class Parameter:
    """A parameter of a model: its value in SI, allowed range and meaning."""

    key: str
    value: float
    unit: str  #: "1" for none, "" for a unit that follows the record's own
    least: float
    most: float
    meaning: str

    def __float__(self) -> float:
        return self.value


class Model:
    """A declared model. It does not change: ``with_values`` gives another one.

    ``Model("declared.toml")`` reads a file, ``Model({"topology": "simplex", "engine": {"inertia": "9490 kg.m^2"}})`` takes
    the same keys as a dictionary. Raises FileError with the words of ``hotfire check``; those of a dictionary name the lines
    of ``hotfire.Model.text_of(dictionary)``.
    """

    def __init__(self, source: Union[str, os.PathLike, Mapping[str, Any]], *, name: str = "model") -> None:
        if isinstance(source, Mapping):
            self._core = _core.Model.parse(text_of(source), name)
        else:
            self._core = _core.Model.load(os.fspath(source))

    @classmethod
    def _of(cls, core: _core.Model) -> Model:
        own = cls.__new__(cls)
        own._core = core
        return own

    @classmethod
    def from_text(cls, text: str, name: str = "model") -> Model:
        """The model of a file's text; ``name`` represents the file in messages."""
        return cls._of(_core.Model.parse(text, name))

    @staticmethod
    def text_of(source: Mapping[str, Any]) -> str:
        """The text of a model file with the keys of a dictionary."""
        return text_of(source)

    @property
    def name(self) -> str:
        return self._core.name

    @property
    def path(self) -> Optional[str]:
        """The file; None for a model without a file."""
        return self._core.path if os.path.exists(self._core.path) else None

    @property
    def topology(self) -> str:
        """direct, simplex, taos or masv."""
        return self._core.topology

    @property
    def text(self) -> str:
        """The model as the text of a file, every number with the digits that restore it."""
        return self._core.text

    @property
    def parameters(self) -> dict[str, Parameter]:
        """The active parameters of the model, by key: ``engine.inertia``; of several axes ``pitch1.engine.inertia``."""
        return {row[0]: Parameter(*row) for row in self._core.parameters()}

    @property
    def effects(self) -> dict[str, Optional[str]]:
        """The active effects and their laws: ``{"effects.gimbal_friction": "lugre"}``."""
        return {name: law or None for name, law in self._core.effects()}

    def __getitem__(self, key: str) -> float:
        """The value of a parameter, in SI."""
        return self.parameters[key].value

    def with_values(self, values: Mapping[str, float]) -> Model:
        """This model with other values of parameters, by key, in SI.

        Raises UsageError for a key that does not act in the model, FileError for a value outside its bounds.
        """
        return Model._of(_core.with_values(self._core, {key: float(value) for key, value in values.items()}))

    def save(self, path: Union[str, os.PathLike]) -> None:
        """Writes the model as a TOML file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.text)

    def __repr__(self) -> str:
        effects = ", ".join(name.removeprefix("effects.") for name in self.effects) or "none"
        return f"Model({self.name}: {self.topology}, effects: {effects})"
