# SPDX-License-Identifier: Apache-2.0
"""A case of hotfire-study, or a challenge case: given/ with the declared model and its records, kept/ with the unseen one."""

import json
import tomllib

import numpy

CHANNELS = ("piston", "engine")


class BadCase(Exception):
    """The folder is no case that can be compared."""


def read_record(path):
    with path.open(encoding="utf-8") as lines:
        titles = [title.split("[")[0].strip() for title in lines.readline().split(",")]
        values = numpy.loadtxt(lines, delimiter=",", ndmin=2).T
    columns = dict(zip(titles, values))
    missing = [name for name in ("time", "command", *CHANNELS) if name not in columns]
    if missing:
        raise BadCase(f"{path}: column {missing[0]} is missing; the comparison needs time, command, piston and engine")
    return {
        "name": path.name,
        "path": path,
        "channels": set(columns),
        "period": (columns["time"][-1] - columns["time"][0]) / (len(columns["time"]) - 1),
        "command": columns["command"],
        "measured": numpy.array([columns[name] for name in CHANNELS]),
    }


class Case:
    """`declared`: values by key; `tolerance`: relative standard deviations by key; `noise`: rms of the channels."""

    def __init__(self, folder):
        given, kept = folder / "given", folder / "kept"
        if not (given / "declared.toml").is_file() or not (kept / "score_noisefree.csv").is_file():
            raise BadCase(f"{folder}: no case (given/declared.toml, kept/score_noisefree.csv); make one with hotfire-study "
                          "effects --only gimbal_friction --seeds 1 --generate-only --out FOLDER")
        with (given / "declared.toml").open("rb") as file:
            model = tomllib.load(file)
        sections = ("servovalve", "actuator", "structure", "engine")
        self.folder = folder
        self.name = folder.resolve().name
        self.model_path = given / "declared.toml"
        self.declared = {f"{part}.{key}": float(value) for part in sections for key, value in model[part].items()}
        self.tolerance = {f"{part}.{key}": value for part, keys in model.get("tolerance", {}).items()
                          for key, value in keys.items()}
        self.noise = numpy.array([float(model["sensors"][f"{name}_noise"]) for name in CHANNELS])
        self.records = [read_record(path) for path in sorted(given.glob("*.csv"))]
        self.unseen = read_record(kept / "score_noisefree.csv")
        self.missing = json.loads((kept / "truth.json").read_text(encoding="utf-8"))["effects"]
        for record in self.records:
            if "load_pressure" in record["channels"]:
                raise BadCase(f"{record['path']}: load_pressure would give the finder a channel that the others do not use; "
                              "take another case")
        if len({round(record["period"], 9) for record in self.records}) != 1:
            raise BadCase(f"{folder}: records of different periods cannot be integrated side by side")

    @staticmethod
    def read(path):
        """Channels of a record, (channel, row)."""
        return read_record(path)["measured"]

    def seconds(self):
        return sum(record["period"] * (len(record["command"]) - 1) for record in self.records)

    def error(self, modelled):
        """Rms over the unseen record of (channel, row), in units of the sensor noise."""
        rms = numpy.sqrt(numpy.mean((modelled - self.unseen["measured"]) ** 2, axis=1))
        return dict(zip(CHANNELS, (rms / self.noise).tolist()))
