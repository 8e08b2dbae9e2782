# SPDX-License-Identifier: Apache-2.0
"""What the finder reports, as objects with units. docs/report.md says what each figure is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional


@dataclass(frozen=True)
class Estimate:
    """A value with its unit and its 95 % interval; no interval where the data do not determine it."""

    value: float
    unit: str
    ci95: Optional[tuple[float, float]]
    meaning: str = ""

    @property
    def identified(self) -> bool:
        return self.ci95 is not None

    def __float__(self) -> float:
        return self.value

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> Estimate:
        interval = json.get("ci95")
        return cls(json["value"], json.get("unit", ""), tuple(interval) if interval else None, json.get("meaning", ""))


@dataclass(frozen=True)
class Effect:
    """An effect that is missing in the declared model."""

    name: str
    site: str
    law: Optional[str]
    axis: Optional[str]
    parameters: dict[str, Estimate]
    evidence: dict[str, float]
    alternatives: list[dict[str, Any]]
    json: Mapping[str, Any]  #: all that report.json says of it

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> Effect:
        return cls(
            json["name"],
            json["site"],
            json.get("law"),
            json.get("axis"),
            {name: Estimate.of(own) for name, own in json["parameters"].items()},
            dict(json.get("evidence", {})),
            list(json.get("alternatives", [])),
            json,
        )


@dataclass(frozen=True)
class Errors:
    """The error of a model in a channel, on data that no fit has seen."""

    rms: float
    max: float
    bias: float
    fit_percent: float


@dataclass(frozen=True)
class ChannelErrors:
    """A channel under the declared model, the calibrated one and the explained one, in its unit."""

    unit: str
    noise: float
    before: Errors
    calibrated: Errors
    after: Errors

    @classmethod
    def of(cls, json: Mapping[str, Any]) -> ChannelErrors:
        def errors(own: Mapping[str, Any]) -> Errors:
            return Errors(own["rms"], own["max"], own["bias"], own["fit_percent"])

        return cls(json["unit"], json["noise"], *(errors(json[name]) for name in ("before", "calibrated", "after")))
