# SPDX-License-Identifier: Apache-2.0
"""Pictures by matplotlib, which is needed for nothing else."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

if TYPE_CHECKING:
    from ._record import Record
    from ._runs import Sweep


def _pyplot() -> Any:
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as error:
        raise ImportError("hotfire.plot needs matplotlib: apt-get install python3-matplotlib") from error
    return pyplot


def _label(name: str, unit: str) -> str:
    return name if unit in ("", "1") else f"{name} [{unit}]"


def record(own: Record, channels: Optional[Sequence[str]] = None, beside: Optional[Record] = None) -> Any:
    """The channels of a record over time, one below the other; those of ``beside`` in the same places. Returns the figure."""
    names = list(own) if channels is None else list(channels)
    figure, places = _pyplot().subplots(len(names), 1, sharex=True, squeeze=False, figsize=(8, 1.2 + 1.6 * len(names)))
    for axes, name in zip(places[:, 0], names):
        channel = own[name]
        axes.plot(own.time, channel.values, label=own.name)
        if beside is not None and name in beside:
            axes.plot(beside.time, beside[name].to(channel.unit), label=beside.name)
            axes.legend(loc="upper right")
        axes.set_ylabel(_label(name, channel.unit))
        axes.grid(True)
    places[-1, 0].set_xlabel("time [s]")
    figure.tight_layout()
    return figure


def sweep(sweeps: Sequence[Sweep]) -> Any:
    """Gain and phase of frequency responses, one line a channel and amplitude. Returns the figure."""
    figure, (gain, phase) = _pyplot().subplots(2, 1, sharex=True, figsize=(8, 6))
    for own in sweeps:
        size = f" at {np.degrees(own.amplitude):.3g} deg" if own.amplitude > 0 else ""
        gain.semilogx(own.frequency, own.gain, label=own.channel + size)
        phase.semilogx(own.frequency, own.phase)
    gain.set_ylabel("gain [dB]")
    phase.set_ylabel("phase [deg]")
    phase.set_xlabel("frequency [Hz]")
    for axes in (gain, phase):
        axes.grid(True, which="both")
    gain.legend()
    figure.tight_layout()
    return figure
