#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the files of a stage in flight that the tests of `hotfire loop` close a loop around: four engines, 5e8 kg m^2, 30 m
from the gimbals to the centre of mass, two bending modes and a local one."""

import math

AXES = [f"{axis}{engine}" for engine in range(1, 5) for axis in ("pitch", "yaw")]
INERTIA, ARM = 5e8, 30.0
NOTHING = [0.0] * 8


def about(axis, value):
    """The value at the ports of one axis of every engine."""
    return [value if own.startswith(axis) else 0.0 for own in AXES]


def modes(with_rigid_body):
    turn = 1 / math.sqrt(INERTIA)
    rows = []
    if with_rigid_body:
        rows += [("pitch", 0, 0, NOTHING, NOTHING, about("pitch", ARM * turn), [turn, 0]),
                 ("yaw", 0, 0, NOTHING, NOTHING, about("yaw", ARM * turn), [0, turn])]
    rows += [("bending_pitch", 1.1, 0.005, about("pitch", 2e-4), about("pitch", 1e-5), about("pitch", 1.2e-3), [-3e-5, 0]),
             ("bending_yaw", 1.1, 0.005, about("yaw", 2e-4), about("yaw", 1e-5), about("yaw", 1.2e-3), [0, -3e-5]),
             ("local", 9.1, 0.02, [4e-3 * math.sin(2 * i + 1) for i in range(8)], NOTHING, NOTHING, [0, 0])]
    header = ["mode", "frequency[Hz]", "damping[1]"]
    header += [f"{kind}.{axis}" for kind in ("attach", "gimbal", "side") for axis in AXES] + ["sensor.pitch", "sensor.yaw"]
    lines = [",".join(header)]
    for name, frequency, damping, attach, gimbal, side, sensor in rows:
        lines.append(f"{name},{frequency},{damping}," + ",".join(f"{own:.9g}" for own in attach + gimbal + side + sensor))
    return "\n".join(lines) + "\n"


MODEL = """schema = 1
topology = "masv"
[structure]
stiffness = 1.05e8
[gimbal]
thrust = 1.86e6
[modes]
table = "modes.csv"
"""

DEAD_BAND = """[effects.valve_deadband]
half_width = 0.05
"""

FRICTION = """[gimbal.friction]
law = "lugre"
coulomb_torque = 3e4
stiffness = 1e8
static_ratio = 1.2
stribeck_velocity = 0.02
damping = 3e3
"""

CONTROLLER = """schema = 1
name = "{}"
axis = "pitch"
period = 0.02
delay = 0.02
gain = {}
rate_gain = {}
integral_gain = {}
[[filter]]
kind = "notch"
frequency = 1.1
damping_ratio = 0.5
"""

FILES = {
    "modes.csv": modes(True),
    "bending.csv": modes(False),
    "linear.toml": MODEL,
    "bending.toml": MODEL.replace("modes.csv", "bending.csv"),
    "dead_band.toml": MODEL + DEAD_BAND,
    "friction.toml": MODEL + FRICTION,
    "axis.toml": 'schema = 1\ntopology = "simplex"\n',
    "pid.toml": CONTROLLER.format("PID", 2.5, 1.5, 0.3),
    "pid_weak.toml": CONTROLLER.format("PID", 2.0, 2.0, 0.6),
    "pd.toml": CONTROLLER.format("PD", 1.5, 2.5, 0.0),
    "pid_bad.toml": CONTROLLER.format("PID", '"high"', 3.0, 0.6),
}

if __name__ == "__main__":
    for name, text in FILES.items():
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
