# SPDX-License-Identifier: Apache-2.0
"""Sparse regression of the missing term (SINDy: Brunton, Proctor and Kutz 2016, PNAS 113(15), 3932-3937).

Measured motion, smoothed and differentiated, is put into the model's equations; what they leave over is fitted by a library of
terms, of which sequentially thresholded least squares keep few. The rival knows the site of the effect, may build on the
declared or on the calibrated model, and smoothing and threshold are chosen by simulation.
"""

import itertools
import time

import numpy
from scipy.signal import cont2discrete, lfilter, savgol_filter

from scipy_rival.axis import Limit, OutOfTime, simulate, with_products
from scipy_rival.effects import NoEffect

WINDOWS = (11, 21, 41, 81)
ORDER = 4
THRESHOLDS = (0.005, 0.02, 0.05, 0.15)
# Of processor that a simulation of a trial may take: a term that makes the model ring with tiny steps is no good one.
TRIAL_SECONDS = 60.0
PASSES = 10

SITES = {"gimbal_friction": "engine_torque", "duct_hardening": "engine_torque", "soft_stiffness": "load_spring",
         "valve_deadband": "valve"}


def odd_terms(variable, size):
    """Terms of one variable. Steep tanh replace its sign: a sign would chatter in any integrator."""
    terms = [(variable, lambda at, s: s / size), (f"{variable} |{variable}|", lambda at, s: s * abs(s) / size**2),
             (f"{variable}^3", lambda at, s: s * s * s / size**3)]
    for width in (0.03, 0.1, 0.3, 1.0):
        terms.append((f"tanh({variable} / {width:g} rms)", lambda at, s, w=width * size: at.tanh(s / w)))
    return terms


def library(site, data):
    """(name, function of (at, first variable, second variable)) for the variables that the site sees."""
    one = [("1", lambda at, s, r: 1.0)]
    first, second = (float(numpy.sqrt(numpy.mean(data[key] ** 2))) for key in ("first", "second"))
    if site != "engine_torque":
        name = "deflection" if site == "load_spring" else "spool"
        own = [(term, lambda at, s, r, f=f: f(at, s)) for term, f in odd_terms(name, first)]
        return one + own + [(f"{name}^2", lambda at, s, r: s * s / first**2)]
    angle = [(term, lambda at, s, r, f=f: f(at, s)) for term, f in odd_terms("angle", first)[:3]]
    rate = [(term, lambda at, s, r, f=f: f(at, r)) for term, f in odd_terms("rate", second)]
    steep = 0.03 * second
    return one + angle + rate + [
        ("angle^2", lambda at, s, r: s * s / first**2),
        ("angle rate", lambda at, s, r: s * r / (first * second)),
        ("angle^2 rate", lambda at, s, r: s * s * r / (first * first * second)),
        ("|angle| sign(rate)", lambda at, s, r: abs(s) * at.tanh(r / steep) / first),
        ("angle^2 sign(rate)", lambda at, s, r: s * s * at.tanh(r / steep) / first**2),
    ]


class Numpy:
    tanh = numpy.tanh


class SparseTerms(NoEffect):
    """The terms kept, as an effect at their site."""

    name = "sparse"

    def __init__(self, site, terms, coefficients):
        self.site = site
        self.kept = [(name, f, float(c)) for (name, f), c in zip(terms, coefficients) if c != 0.0]

    def total(self, at, first, second):
        return sum(c * f(at, first, second) for _, f, c in self.kept)

    def opening(self, p, at, spool):
        return spool + self.total(at, spool, 0.0) if self.site == "valve" else spool

    def spring(self, p, at, deflection):
        force = p["stiffness"] * deflection
        return force + self.total(at, deflection, 0.0) if self.site == "load_spring" else force

    def torque(self, p, at, angle, rate, own):
        return (self.total(at, angle, rate) if self.site == "engine_torque" else 0.0,)

    def words(self):
        return " + ".join(f"{c:.4g} {name}" for name, _, c in self.kept) or "nothing"


def missing_opening(p, record, piston, force, period):
    """Spool, and how much of its opening is missing, by the valve's own equations driven by what was measured."""
    area = p["actuator.piston_area"]
    pressure = (p["actuator.piston_mass"] * piston[2] + p["actuator.piston_damping"] * piston[1] + force) / area
    corner, frequency = p["servovalve.pressure_feedback_corner"], p["servovalve.natural_frequency"]
    held = cont2discrete(([1.0, 0.0], [1.0, corner]), period, "bilinear")
    fed_back = p["servovalve.pressure_feedback_gain"] * lfilter(held[0].ravel(), held[1], pressure)
    wanted = p["servovalve.position_gain"] * (p["actuator.moment_arm"] * record["command"] - piston[0]) - fed_back
    spool_law = ([frequency**2], [1.0, 2.0 * p["servovalve.damping_ratio"] * frequency, frequency**2])
    spool_held = cont2discrete(spool_law, period, "zoh")
    spool = lfilter(spool_held[0].ravel(), spool_held[1], numpy.clip(wanted, -1.0, 1.0))
    flow = numpy.gradient(pressure, period) / p["oil"] + area * piston[1] + p["actuator.leakage"] * pressure
    root = numpy.sqrt(numpy.maximum(0.05, 1.0 - numpy.sign(spool) * pressure / p["actuator.supply_pressure"]))
    return spool, flow / (p["servovalve.rated_flow"] * root) - spool


def missing_term(values, site, records, window):
    """The missing quantity of the site's equation and the two variables that it may depend on, all records in a row."""
    p = with_products(values)
    parts = []
    for record in records:
        period = record["period"]
        piston, angle = ([savgol_filter(channel, window, ORDER, deriv=k, delta=period) for k in range(3)]
                         for channel in record["measured"])
        arm = p["actuator.moment_arm"]
        deflection = piston[0] - arm * angle[0]
        force = p["stiffness"] * deflection
        torque = (p["engine.inertia"] * angle[2] + p["engine.viscous_damping"] * angle[1]
                  + p["engine.duct_stiffness"] * angle[0])
        if site == "engine_torque":
            part = angle[0], angle[1], arm * force - torque
        elif site == "load_spring":
            part = deflection, angle[1], torque / arm - force
        else:
            spool, missing = missing_opening(p, record, piston, torque / arm, period)
            part = spool, angle[1], missing
        parts.append([each[window:-window] for each in part])
    return dict(zip(("first", "second", "missing"), (numpy.concatenate(each) for each in zip(*parts))))


def thresholded_least_squares(columns, target, threshold):
    """Terms whose contribution stays below a share of the target's rms are taken out, the rest fitted again."""
    sizes = numpy.sqrt(numpy.mean(columns**2, axis=0))
    keep = numpy.ones(columns.shape[1], bool)
    coefficients = numpy.zeros(columns.shape[1])
    for _ in range(PASSES):
        coefficients[:] = 0.0
        coefficients[keep] = numpy.linalg.lstsq(columns[:, keep], target, rcond=1e-8)[0]
        stays = keep & (abs(coefficients) * sizes > threshold * numpy.sqrt(numpy.mean(target**2)))
        if (stays == keep).all() or not stays.any():
            break
        keep = stays
    return coefficients


def fit_sparse(case, effect_name, bases, progress):
    """`bases`: names and values of the models to build on. Returns what could simulate the shortest record, best first."""
    began, processor_began = time.monotonic(), time.process_time()
    site = SITES[effect_name]
    shortest = min(case.records, key=lambda record: len(record["command"]))
    models = []
    trials = list(itertools.product(bases.items(), WINDOWS, THRESHOLDS))
    for count, ((base, values), window, threshold) in enumerate(trials, 1):
        data = missing_term(values, site, case.records, window)
        terms = library(site, data)
        columns = numpy.array([numpy.broadcast_to(f(Numpy, data["first"], data["second"]), data["missing"].shape)
                               for _, f in terms]).T
        sparse = SparseTerms(site, terms, thresholded_least_squares(columns, data["missing"], threshold))
        try:
            modelled = simulate(values, sparse, [shortest], watch=Limit(TRIAL_SECONDS))[0][:, 0]
        except (OutOfTime, RuntimeError, OverflowError, ValueError):
            continue
        cost = float(numpy.mean(((modelled - shortest["measured"]) / case.noise[:, None]) ** 2))
        models.append({"cost": cost, "terms": sparse, "values": values, "base": base, "window": window,
                       "threshold": threshold})
        models.sort(key=lambda model: model["cost"])
        progress(f"{count} of {len(trials)} libraries, best so far {models[0]['cost'] ** 0.5:.3g} times the noise")
    took = {"wall_seconds": time.monotonic() - began, "processor_seconds": time.process_time() - processor_began}
    return models, took
