# SPDX-License-Identifier: Apache-2.0
"""Records: uniformly sampled channels with units."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core

Values = npt.NDArray[np.float64]
#: A channel as it is given: values in SI, or values with their unit.
Given = Union[npt.ArrayLike, "tuple[npt.ArrayLike, str]"]

_SI = {"command": "rad", "current": "A", "piston": "m", "engine": "rad", "load_pressure": "Pa", "torque": "N.m",
       "thrust": "N", "motor_position": "rad", "motor_velocity": "rad/s", "string1": "m", "string2": "m", "string3": "m", "string4": "m"}


def _unit_of(name: str) -> str:
    """The SI unit of a channel; "1" for one that keeps the unit that it has."""
    own, _, place = name.partition(".")
    if own == "vibration":
        return "rad/s" if place else "m/s^2"
    if own == "force" and place:
        return "N"
    return _SI.get(own, "1")


@dataclass(frozen=True)
class Channel:
    """One channel of a record. It is an array to numpy."""

    name: str
    unit: str
    values: Values  #: not to be written to: they are the record's own

    def to(self, unit: str) -> Values:
        """The values in another unit. Raises UnitError for one of another dimension."""
        offset = _core.convert_unit(0.0, self.unit, unit)
        return self.values * (_core.convert_unit(1.0, self.unit, unit) - offset) + offset

    def __array__(self, dtype: npt.DTypeLike = None) -> npt.NDArray:
        return np.asarray(self.values, dtype=dtype)

    def __len__(self) -> int:
        return len(self.values)

    def __repr__(self) -> str:
        return f"Channel({self.name} [{self.unit}], {len(self.values)} rows)"


class Record(Mapping):
    """A uniformly sampled record: a mapping from the names of its channels to the channels.

    ``Record("steps.csv")`` reads a file as ``hotfire check`` reads it. ``Record({"command": values}, period=1e-3)`` takes
    arrays, in SI or with their unit: ``{"command": (values, "deg")}``. Raises FileError for what the commands refuse.
    """

    def __init__(
        self,
        source: Union[str, os.PathLike, Mapping[str, Given]],
        *,
        period: Optional[float] = None,
        start: float = 0.0,
        name: str = "record",
    ) -> None:
        if not isinstance(source, Mapping):
            if period is not None:
                raise _core.UsageError("a file has its own time: period is for arrays")
            self._core = _core.Record.load(os.fspath(source))
            return
        if period is None or not source:
            raise _core.UsageError("a record of arrays has at least one channel and a period [s]: Record({...}, period=1e-3)")
        channels = []
        for channel, given in source.items():
            values, unit = given if isinstance(given, tuple) and len(given) == 2 and isinstance(given[1], str) else (given, _unit_of(channel))
            channels.append((channel, unit, np.asarray(values, dtype=np.float64)))
        self._core = _core.Record.from_channels(channels, float(start), float(period), name)

    @classmethod
    def _of(cls, core: _core.Record) -> Record:
        own = cls.__new__(cls)
        own._core = core
        return own

    def __getitem__(self, name: str) -> Channel:
        return Channel(name, self._core.unit_of(name), self._core.values_of(name))

    def __iter__(self) -> Iterator[str]:
        return iter(self._core.channel_names())

    def __len__(self) -> int:
        return len(self._core.channel_names())

    @property
    def name(self) -> str:
        """The name of the file, without folder."""
        return self._core.name

    @property
    def rows(self) -> int:
        return len(self._core)

    @property
    def period(self) -> float:
        """Sampling period [s]."""
        return self._core.period

    @property
    def start(self) -> float:
        """Time of the first row [s]."""
        return self._core.start

    @property
    def time(self) -> Values:
        """Time of every row [s]."""
        return self._core.time

    def save(self, path: Union[str, os.PathLike]) -> None:
        """Writes the record as CSV, each number with the digits that restore it."""
        self._core.save(os.fspath(path))

    def __repr__(self) -> str:
        channels = ", ".join(f"{channel.name}[{channel.unit}]" for channel in self.values())
        return f"Record({self.name}: {self.rows} rows, period {self.period:g} s, {channels})"
