#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Margins of a vehicle's loop from A, B, C, D, apart from the program's own code:
margins_by_scipy.py MODEL.mat MODES.csv THRUST RESULT.json. Plant and modes are put together in continuous time, sampled by scipy with the controller's period and its
delay, and the margins are found by brentq. Compared with the result of `hotfire loop --json`."""

import csv
import json
import sys

import numpy as np
import scipy.io
import scipy.linalg
import scipy.optimize

PERIOD, DELAY = 0.02, 0.02
GAIN, RATE_GAIN, INTEGRAL_GAIN = 2.5, 1.5, 0.3
NOTCH, DAMPING = 1.1, 0.5


def plant(path):
    m = scipy.io.loadmat(path)
    names = [str(own[0][0]) for own in m["output_names"]]
    inputs = [str(own[0][0]) for own in m["input_names"]]
    engines = [names.index(f"engine.{a}{e}") for e in range(1, 5) for a in ("pitch", "yaw")]
    commands = [inputs.index(f"command.pitch{e}") for e in range(1, 5)]
    return m["A"], m["B"][:, commands].sum(axis=1, keepdims=True), m["C"][engines], m["D"][np.ix_(engines, commands)].sum(
        axis=1, keepdims=True)


def stage(path, thrust):
    rows = list(csv.DictReader(open(path)))
    sides = [f"side.{a}{e}" for e in range(1, 5) for a in ("pitch", "yaw")]
    n = len(rows)
    a, b, c = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 8)), np.zeros((2, 2 * n))
    for k, row in enumerate(rows):
        w = 2 * np.pi * float(row["frequency[Hz]"])
        a[2 * k, 2 * k + 1] = 1
        a[2 * k + 1, 2 * k] = -w * w
        a[2 * k + 1, 2 * k + 1] = -2 * float(row["damping[1]"]) * w
        b[2 * k + 1] = [thrust * float(row[side]) for side in sides]
        c[0, 2 * k] = c[1, 2 * k + 1] = float(row["sensor.pitch"])
    return a, b, c


def open_loop(plant_path, modes_path, thrust):
    a1, b1, c1, d1 = plant(plant_path)
    a2, b2, c2 = stage(modes_path, thrust)
    a = np.block([[a1, np.zeros((len(a1), len(a2)))], [b2 @ c1, a2]])
    b = np.vstack([b1, b2 @ d1])
    c = np.hstack([np.zeros((2, len(a1))), c2])
    n = len(a)
    sampled = scipy.linalg.expm(np.block([[a, b], [np.zeros((1, n + 1))]]) * PERIOD)
    ad, bd = sampled[:n, :n], sampled[:n, n:]

    def loop(f):
        z = np.exp(2j * np.pi * f * PERIOD)
        y = c @ np.linalg.solve(z * np.eye(n) - ad, bd) * np.exp(-2j * np.pi * f * DELAY)
        w = 2 * np.pi * NOTCH
        s = w / np.tan(w * PERIOD / 2) * (z - 1) / (z + 1)
        notch = (s * s + w * w) / (s * s + 2 * DAMPING * w * s + w * w)
        return complex(notch * ((GAIN + INTEGRAL_GAIN * PERIOD * z / (z - 1)) * y[0, 0] + RATE_GAIN * y[1, 0]))

    return loop


def compare(loop, result):
    small = result["open_loop"][0]
    assert small["amplitude_degrees"] == 0 and small["phase_margins"] and len(small["gain_margins"]) >= 2, small
    for own in small["phase_margins"]:
        f = scipy.optimize.brentq(lambda f: np.log(abs(loop(f))), own["hertz"] * 0.98, own["hertz"] * 1.02, xtol=1e-14)
        degrees = np.degrees(np.angle(-loop(f)))
        assert abs(degrees - own["degrees"]) < 0.01, (own, f, degrees)
    for own in small["gain_margins"]:
        f = scipy.optimize.brentq(lambda f: np.angle(-loop(f)), own["hertz"] * 0.99, own["hertz"] * 1.01, xtol=1e-14)
        decibels = -20 * np.log10(abs(loop(f)))
        assert abs(decibels - own["decibels"]) < 0.01, (own, f, decibels)
    return len(small["phase_margins"]) + len(small["gain_margins"])


if __name__ == "__main__":
    count = compare(open_loop(sys.argv[1], sys.argv[2], float(sys.argv[3])), json.load(open(sys.argv[4])))
    print(f"{count} margins as by scipy")
