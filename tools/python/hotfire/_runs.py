# SPDX-License-Identifier: Apache-2.0
"""Runs of a model: simulation, batches, gradients, sweeps."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._model import Model
from ._record import Record, Values


def _threads(threads: Optional[int]) -> int:
    if threads is not None and threads < 1:
        raise _core.UsageError(f"threads = {threads}; allowed: at least 1")
    return threads or len(os.sched_getaffinity(0))


def simulate(
    model: Model,
    inputs: Union[Record, npt.ArrayLike],
    *,
    period: Optional[float] = None,
    fit_start: int = 0,
    seed: int = 1,
) -> Record:
    """Runs a model open loop, as ``hotfire simulate`` does, and with its bits.

    ``inputs`` is a record with the input channels of the model's topology, or for one axis an array: the command [rad], or
    the force of a ``direct`` model, with its ``period`` [s]. ``fit_start`` rows fit the start of a ``direct`` mass. ``seed``
    is that of the sensors' noise of a model of several axes. Other threads of Python go on meanwhile.
    """
    return Record._of(_core.simulate(model._core, _inputs(model, inputs, period)._core, fit_start, seed))


def _inputs(model: Model, inputs: Union[Record, npt.ArrayLike], period: Optional[float]) -> Record:
    if isinstance(inputs, Record):
        if period is not None:
            raise _core.UsageError("a record has its own period; period is for an array")
        return inputs
    if model.topology in ("taos", "masv"):
        raise _core.UsageError("an array is the command of one axis; give a Record with command.pitch, command.yaw ...")
    return Record({"force" if model.topology == "direct" else "command": np.asarray(inputs)}, period=period)


def simulate_many(
    models: Union[Model, Sequence[Model]],
    inputs: Union[Record, Sequence[Record]],
    *,
    fit_start: int = 0,
    seed: int = 1,
    threads: Optional[int] = None,
) -> list[Record]:
    """Several runs at once, on as many threads as the process has cores, or ``threads``.

    One model and many records, many models and one record, or as many of both. The results are in that order, and each has
    the bits of ``simulate``. Models of one hydraulic axis that differ in their numbers alone, on records of the same length
    and period, run eight at a time in the registers of a core: with AVX2 three times as fast.
    """
    many_models = [models] if isinstance(models, Model) else list(models)
    many_inputs = [inputs] if isinstance(inputs, Record) else list(inputs)
    count = max(len(many_models), len(many_inputs)) if many_models and many_inputs else 0
    for values, what in ((many_models, "models"), (many_inputs, "records")):
        if len(values) not in (1, count):
            raise _core.UsageError(f"{len(many_models)} models and {len(many_inputs)} records; allowed: as many, or one of either")
        values *= count if len(values) == 1 else 1
    runs = [(model._core, record._core) for model, record in zip(many_models, many_inputs)]
    return [Record._of(core) for core in _core.simulate_many(runs, fit_start, seed, _threads(threads))]


@dataclass(frozen=True)
class Gradients:
    """Exact derivatives of a run by parameters.

    ``gradients["engine"]`` has a row for each row of the record and a column for each of ``keys``.
    """

    keys: tuple[str, ...]
    units: dict[str, tuple[str, ...]]  #: by channel, of each column: the channel's over the parameter's
    slopes: dict[str, Values]

    def __getitem__(self, channel: str) -> Values:
        return self.slopes[channel]


def gradients(
    model: Model,
    inputs: Union[Record, npt.ArrayLike],
    keys: Optional[Iterable[str]] = None,
    *,
    period: Optional[float] = None,
    threads: Optional[int] = None,
) -> Gradients:
    """The derivatives of what ``simulate`` gives by the parameters of ``keys``, all that act by default.

    They are exact: the run is made with dual numbers. Where friction turns over they are those of its either side. Of
    several axes a parameter takes a run of its own, on as many threads as the process has cores, or ``threads``; the
    slopes are of readings without noise and steps. Raises UsageError for a key that does not act in the model.
    """
    record = _inputs(model, inputs, period)
    wanted = tuple(_core.acting_keys(model._core) if keys is None else keys)
    slopes = _core.gradients(model._core, record._core, list(wanted), _threads(threads))
    units = {
        "piston": "m",
        "engine": "rad",
        "load_pressure": "Pa",
        "motor_position": "rad",
        "motor_velocity": "rad/s",
        "current": "A",
        **{f"string{number}": "m" for number in range(1, 5)},
        # Of a mass the record decides the unit, as for the parameters.
        "position": "position",
        "velocity": "position/time",
        "acceleration": "position/time^2",
    }
    of_keys = {key: parameter.unit for key, parameter in model.parameters.items()}
    quotients = {
        channel: tuple(f"{units.get(channel.partition('.')[0], '1')}/({of_keys[key] or '1'})" for key in wanted) for channel in slopes
    }
    return Gradients(wanted, quotients, slopes)


@dataclass(frozen=True)
class Sweep:
    """The frequency response of one channel to sines of one amplitude."""

    channel: str
    amplitude: float  #: of the sines [rad]; 0 for a broadband command
    frequency: Values  #: [Hz]
    gain: Values  #: over the command; of the piston over command times arm [dB]
    phase: Values  #: continued over 180 degrees [deg]
    coherence: Values  #: share of the power that is linear in the command
    notch: Optional[dict[str, float]]  #: hertz, gain_decibels, depth_decibels
    peak: Optional[dict[str, float]]  #: hertz, gain_decibels
    record: Optional[Record]  #: of the run, if it was made here


def _sweeps(text: str, record: Optional[Record]) -> list[Sweep]:
    def column(rows: list[dict[str, Any]], name: str) -> Values:
        return np.array([row[name] for row in rows], dtype=np.float64)

    return [
        Sweep(
            own["channel"],
            math.radians(own["amplitude_degrees"]),
            column(own["response"], "hertz"),
            column(own["response"], "gain_decibels"),
            column(own["response"], "phase_degrees"),
            column(own["response"], "coherence"),
            own["notch"],
            own["peak"],
            record,
        )
        for own in json.loads(text)
    ]


def sweep(
    model: Model,
    *,
    amplitudes: Sequence[float] = (math.radians(0.4),),
    frequencies: tuple[float, float] = (0.4, 14.0),
    count: int = 40,
    coarse: bool = False,
    axis: str = "",
    band: tuple[float, float] = (3.0, 20.0),
) -> list[Sweep]:
    """Frequency responses of piston and engine by stepped sines, as ``hotfire sweep --profile sines`` gives them.

    ``amplitudes`` are in rad, a sweep each. ``frequencies`` are the lowest and the highest [Hz], with ``count`` at equal
    ratios, and ``band`` is where notch and peak are looked for [Hz]. Each is held until the modes settle, and the run is made
    again with a fine grid around each notch. With ``coarse`` each is held for 2 s, once. ``axis`` is that of a model of several: pitch, yaw2.
    """
    record, text = _core.sweep(
        model._core, [float(a) for a in amplitudes], *map(float, frequencies), count, coarse, axis, *map(float, band)
    )
    return _sweeps(text, Record._of(record))


def analyse_sweep(
    record: Record, *, axis: str = "", moment_arm: float = 1.0, band: tuple[float, float] = (3.0, 20.0), segment: float = 8.0
) -> list[Sweep]:
    """The same of a record: sine by sine where its command is a stepped sine, by Welch's method otherwise.

    ``moment_arm`` [m] makes the piston's gain one over command times arm; ``segment`` is Welch's [s].
    """
    return _sweeps(_core.analyse_sweep(record._core, axis, moment_arm, *map(float, band), segment), record)
