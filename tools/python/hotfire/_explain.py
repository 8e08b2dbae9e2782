# SPDX-License-Identifier: Apache-2.0
"""The finder: the effects that are missing in a declared model, from measured records."""

from __future__ import annotations

import html as _html
import json
import os
import time
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime, timezone
from functools import cached_property
from pathlib import Path
from typing import Any, Optional, Union

from . import _core
from ._model import Model
from ._record import Record
from ._results import ChannelErrors, Effect, Estimate
from ._runs import _threads


class Explanation:
    """What ``hotfire explain`` found. In a notebook it shows itself as the report page."""

    def __init__(self, report: dict[str, Any], series: _core.ReportSeries, model: Model, next_experiment: Optional[Record]):
        self.report = report  #: report.json
        self.model = model  #: the explained model
        self.next_experiment = next_experiment  #: the command that would separate two explanations
        self._series = series

    @property
    def verdict(self) -> str:
        """explained, nothing-missing, partly-explained, unlisted-effect or undecided."""
        return self.report["verdict"]

    @property
    def sentence(self) -> str:
        return self.report["sentence"]

    @property
    def effects(self) -> list[Effect]:
        return [Effect.of(own) for own in self.report["effects"]]

    @property
    def channels(self) -> dict[str, ChannelErrors]:
        return {name: ChannelErrors.of(own) for name, own in self.report["channels"].items()}

    @property
    def calibration(self) -> dict[str, Estimate]:
        return {key: Estimate.of(own) for key, own in self.report["calibration"].items()}

    @property
    def warnings(self) -> list[str]:
        return list(self.report.get("warnings", []))

    @cached_property
    def html(self) -> str:
        """The report page, which needs no network."""
        return _core.report_page(json.dumps(self.report), self._series)

    def save(self, folder: Union[str, os.PathLike]) -> None:
        """Writes explained.toml, report.json, report.html and, if there is one, next_experiment.csv."""
        out = Path(folder)
        out.mkdir(parents=True, exist_ok=True)
        self.model.save(out / "explained.toml")
        (out / "report.json").write_text(json.dumps(self.report, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
        (out / "report.html").write_text(self.html, encoding="utf-8")
        (out / "next_experiment.csv").unlink(missing_ok=True)
        if self.next_experiment is not None:
            self.next_experiment.save(out / "next_experiment.csv")

    def _repr_html_(self) -> str:
        page = _html.escape(self.html, quote=True)
        return f'<iframe srcdoc="{page}" style="width: 100%; height: 48em; border: 0" title="report of hotfire"></iframe>'

    def __repr__(self) -> str:
        return f"Explanation({self.verdict}: {self.sentence})"


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during ``explain``. ``explanation`` is what is known so far."""

    def __init__(self, explanation: Explanation) -> None:
        super().__init__("explain was interrupted; .explanation is what is known so far")
        self.explanation = explanation


def _put_digests(records: Sequence[Record], reported: list[dict[str, Any]]) -> None:
    """Adds the SHA-256 of each record that is a file."""
    for record, own in zip(records, reported):
        if os.path.isfile(record._core.path):
            own["sha256"] = _core.sha256(record._core.path)


def explain(
    model: Model,
    records: Union[Record, Iterable[Record]],
    *,
    hold_out: Iterable[Record] = (),
    exclude: Iterable[str] = (),
    most_effects: int = 4,
    threads: Optional[int] = None,
    progress: Optional[Callable[[str], None]] = None,
) -> Explanation:
    """Identifies the effects that are missing in a declared model, from measured records, as ``hotfire explain`` does and with its figures.

    The model is judged on ``hold_out`` records at the end; no fit uses them. ``exclude`` names rows that are known to be wrong:
    "steps.csv@3.0-3.5". ``progress`` is called with a sentence for each step of the search. Ctrl-C ends the search with
    Interrupted, which has what is known so far; an exception of ``progress`` ends it too, and is raised.
    """
    if not 0 <= most_effects <= 8:
        raise _core.UsageError(f"most_effects = {most_effects}; allowed: 0 to 8")
    measured = [records] if isinstance(records, Record) else list(records)
    kept_back = list(hold_out)
    began = time.monotonic()
    text, series, core, next_experiment, raised = _core.explain(
        model._core,
        [record._core for record in measured],
        [record._core for record in kept_back],
        _threads(threads),
        most_effects,
        list(exclude),
        progress,
    )
    report = json.loads(text)
    report["hotfire"] = _core.version
    if model.path is not None:
        report["model_sha256"] = _core.sha256(model.path)
    _put_digests(measured, report["records"])
    _put_digests(kept_back, report.get("held_out_records", []))
    report["date"] = datetime.now(timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
    report["command_line"] = f"hotfire.explain in Python, hotfire {_core.version}"
    report["seconds"] = time.monotonic() - began
    found = Explanation(report, series, Model._of(core), Record._of(next_experiment) if next_experiment else None)
    if isinstance(raised, KeyboardInterrupt):
        raise Interrupted(found) from raised
    if raised is not None:
        raise raised
    return found
