# SPDX-License-Identifier: Apache-2.0
"""Hotfire in Python: the model of a thrust-vector-control axis, and what is missing in a declared model.

    import hotfire

    model = hotfire.Model("declared.toml")
    record = hotfire.Record("sweep.csv")
    run = hotfire.simulate(model, record)
    run["engine"].values                      # a numpy array, in run["engine"].unit
    found = hotfire.explain(model, [record])
    found.verdict, found.effects

Everything is in SI unless a unit is given. Errors have the words of the command `hotfire`: FileError for bad data, UsageError
for wrong use. docs/interfaces/python.md is the manual.
"""

from ._core import FileError, UnitError, UsageError
from ._core import version as __version__
from ._explain import Explanation, Interrupted, explain
from ._model import Model, Parameter
from ._record import Channel, Record
from ._results import ChannelErrors, Effect, Errors, Estimate
from ._runs import Gradients, Sweep, analyse_sweep, gradients, simulate, simulate_many, sweep
from . import plot

for _error in (FileError, UnitError, UsageError):
    _error.__module__ = __name__

__all__ = [
    "Channel",
    "ChannelErrors",
    "Effect",
    "Errors",
    "Estimate",
    "Explanation",
    "FileError",
    "Gradients",
    "Interrupted",
    "Model",
    "Parameter",
    "Record",
    "Sweep",
    "UnitError",
    "UsageError",
    "analyse_sweep",
    "explain",
    "gradients",
    "plot",
    "simulate",
    "simulate_many",
    "sweep",
]
