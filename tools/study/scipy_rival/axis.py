# SPDX-License-Identifier: Apache-2.0
"""One hydraulic axis for scipy's solve_ivp: the equations of docs/physics.md, section 1.

The equations are written once, for floats and for arrays: plain floats are the quickest for one simulation, arrays for many
parameter sets and records side by side in one integration.
"""

import math
import time

import numpy
from scipy.integrate import solve_ivp

# In the order of the state: washout, spool and its rate, pressure, piston and its rate, angle and its rate.
STATES = 8
# What is small for each of them: a thousandth of what the records reach. Absolute tolerances are shares of it.
SMALL = (1e4, 1e-3, 1e-1, 1e5, 1e-4, 1e-3, 1e-4, 1e-3)
PISTON, ANGLE = 4, 6
# The oil rings at 2100 rad/s, so that stability and not accuracy sets the step: a cheap explicit method follows an exact hold to
# 0.05 of the sensor noise, with an error that is alike at neighbouring parameters. At rest implicit methods are quicker.
METHOD, RELATIVE_TOLERANCE = "RK23", 1e-3


class Scalars:
    """Functions of floats."""

    sqrt, sign = math.sqrt, staticmethod(lambda x: math.copysign(1.0, x))
    lower, upper, tanh = max, min, math.tanh

    @staticmethod
    def exp(x):
        return math.exp(max(x, -700.0))


class Arrays:
    """The same functions of arrays."""

    sqrt, sign, exp, tanh = numpy.sqrt, numpy.sign, numpy.exp, numpy.tanh
    lower, upper = numpy.maximum, numpy.minimum


def derivative(p, effect, at, command, y):
    """Rates of all states. `p`: values by the keys of a model file; `at`: Scalars or Arrays; `command`: angle [rad]."""
    washout, spool, spool_rate, pressure, piston, piston_rate, angle, angle_rate = y[:STATES]
    arm = p["actuator.moment_arm"]
    change = pressure - washout
    wanted = p["servovalve.position_gain"] * (arm * command - piston) - p["servovalve.pressure_feedback_gain"] * change
    wanted = at.lower(at.upper(wanted, 1.0), -1.0)
    frequency = p["servovalve.natural_frequency"]
    opening = effect.opening(p, at, spool)
    drop = at.lower(0.0, 1.0 - at.sign(opening) * pressure / p["actuator.supply_pressure"])
    flow = p["servovalve.rated_flow"] * opening * at.sqrt(drop)
    area = p["actuator.piston_area"]
    force = effect.spring(p, at, piston - arm * angle)
    torque, *effect_rates = effect.torque(p, at, angle, angle_rate, y[STATES:])
    return (
        p["servovalve.pressure_feedback_corner"] * change,
        spool_rate,
        frequency * frequency * (wanted - spool) - 2.0 * p["servovalve.damping_ratio"] * frequency * spool_rate,
        p["oil"] * (flow - area * piston_rate - p["actuator.leakage"] * pressure),
        piston_rate,
        (area * pressure - force - p["actuator.piston_damping"] * piston_rate) / p["actuator.piston_mass"],
        angle_rate,
        (arm * force - p["engine.viscous_damping"] * angle_rate - p["engine.duct_stiffness"] * angle - torque)
        / p["engine.inertia"],
        *effect_rates,
    )


def with_products(p):
    """Adds what the equations need of several values: 4 B / V_t, and the series of the two stiffnesses."""
    actuator, load = p["actuator.stiffness"], p["structure.stiffness"]
    return p | {
        "oil": 4.0 * p["actuator.bulk_modulus"] / p["actuator.trapped_volume"],
        "stiffness": actuator * load / (actuator + load),
    }


class Command:
    """The commands of one or more records as functions of time from their first row.

    A command is held between rows. It is given as its linear interpolation half a row later, which has the hold's mean and its
    delay to second order: steps of a hold would stop the integrator at every row.
    """

    def __init__(self, commands, period):
        rows = max(len(each) for each in commands)
        self.period = period
        self.last = rows - 2
        padded = numpy.array([numpy.pad(each, (0, rows - len(each)), mode="edge") for each in commands])
        self.values = padded.T[:, :, None] if len(commands) > 1 else padded[0].tolist()

    def at(self, time):
        place = max(0.0, time / self.period - 0.5)
        row = min(int(place), self.last)
        below = self.values[row]
        return below + (self.values[row + 1] - below) * (place - row)


class OutOfTime(Exception):
    """The time that a rival was given is over."""


class Limit:
    """Called, raises OutOfTime once this process has used so many seconds of processor since the limit was made."""

    def __init__(self, seconds):
        self.end = time.process_time() + seconds

    def __call__(self):
        if time.process_time() > self.end:
            raise OutOfTime


def simulate(p, effect, records, copies=None, method=METHOD, tolerance=RELATIVE_TOLERANCE, watch=lambda: None):
    """Piston and angle at the rows of every record: a list of arrays (channel, copy, row).

    `copies`: how many values each array in `p` holds; None if they are floats, for one record. `watch` is called now and
    then and may raise.
    """
    at = Scalars if copies is None else Arrays
    p = with_products(p)
    period = records[0]["period"]
    command = Command([record["command"] for record in records], period)
    small = numpy.concatenate([SMALL, effect.small])
    shape = (len(small), len(records), copies or 1)
    calls = 0

    def rates(time, y):
        nonlocal calls
        calls += 1
        if calls % 1000 == 0:
            watch()
        if copies is None:
            return derivative(p, effect, at, command.at(time), y.tolist())
        out = numpy.empty(shape)
        for row, rate in zip(out, derivative(p, effect, at, command.at(time), y.reshape(shape))):
            row[:] = rate
        return out.ravel()

    rows = max(len(record["command"]) for record in records)
    times = numpy.arange(rows) * period
    solution = solve_ivp(
        rates,
        (0.0, times[-1]),
        numpy.zeros(math.prod(shape)),
        method=method,
        t_eval=times,
        rtol=tolerance,
        atol=numpy.repeat(0.1 * tolerance * small, shape[1] * shape[2]),
        # From rest the first step would be as long as the record.
        max_step=10.0 * period,
    )
    if not solution.success:
        raise RuntimeError("solve_ivp: " + solution.message)
    states = solution.y.reshape(*shape, rows)
    return [states[[PISTON, ANGLE], i, :, : len(record["command"])] for i, record in enumerate(records)]
