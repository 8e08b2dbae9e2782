# SPDX-License-Identifier: Apache-2.0
"""scipy's least_squares over solve_ivp: one candidate and the declared parameters, on all records."""

import time

import numpy
from scipy.optimize import least_squares

from scipy_rival.axis import Limit, OutOfTime, simulate

# Forward differences over so much of a parameter's scale: far above the integrator's own error, far below any curvature.
STEP = 0.02
# Relative change of the cost, or of the parameters, at which a fit has converged.
TOLERANCE = 1e-4
# Residual of a point at which the model cannot be simulated: the step is taken back.
DIVERGED = 1e4


class Fit:
    """Simulation error in units of the noise, and declared tolerances as a prior.

    Coordinates: tolerances from the declared value (below half of it of the logarithm), and of an effect's field the
    logarithm over its start (or the value in starts where it may be negative).

    `side_by_side`: all parameter sets of a Jacobian and all records in one integration of arrays; otherwise one after the
    other, in floats.
    """

    def __init__(self, case, effect, side_by_side, limit, progress):
        self.case, self.effect, self.side_by_side = case, effect, side_by_side
        self.progress = progress
        self.keys = [key for key in case.tolerance if case.declared.get(key)]
        self.began = time.monotonic()
        self.processor_began = time.process_time()
        self.watch = Limit(limit)
        self.rows = sum(record["measured"].size for record in case.records)
        self.simulations = 0
        self.last = (b"", None)
        self.jacobians = {}
        self.best = (numpy.inf, self.start())

    def start(self):
        return numpy.array([0.0] * len(self.keys) + [0.0 if low > 0.0 else 1.0 for _, _, low in self.effect.fields])

    def lowest(self):
        return numpy.array([(0.1 - 1.0) / self.case.tolerance[key] for key in self.keys] +
                           [numpy.log(low / start) if low > 0.0 else low / start for _, start, low in self.effect.fields])

    def values(self, x):
        """Parameters of one coordinate vector, or of several as columns."""
        p = dict(self.case.declared)
        for key, u in zip(self.keys, x):
            share = 1.0 + self.case.tolerance[key] * u
            p[key] = p[key] * numpy.where(share < 0.5, 0.5 * numpy.exp(2.0 * numpy.minimum(share, 0.5) - 1.0), share)
        for (name, start, low), u in zip(self.effect.fields, x[len(self.keys):]):
            p[f"{self.effect.name}.{name}"] = start * (numpy.exp(u) if low > 0.0 else u)
        return p

    def residuals_of(self, points):
        """One row a point: all records, both channels; then the prior."""
        if self.side_by_side:
            modelled = simulate(self.values(points.T), self.effect, self.case.records, len(points), watch=self.watch)
        else:
            each = [[simulate({key: float(value) for key, value in self.values(x).items()}, self.effect, [record],
                              watch=self.watch)[0] for record in self.case.records] for x in points]
            modelled = [numpy.concatenate([one[i] for one in each], axis=1) for i in range(len(self.case.records))]
        self.simulations += len(points)
        noise = self.case.noise[:, None, None]
        errors = [(model - record["measured"][:, None, :]) / noise for model, record in zip(modelled, self.case.records)]
        return numpy.hstack([*(error.transpose(1, 0, 2).reshape(len(points), -1) for error in errors),
                             points[:, :len(self.keys)]])

    def residual(self, x):
        """Side by side the Jacobian costs next to nothing more: it is had with every residual."""
        points = numpy.vstack([x, x + STEP * numpy.eye(len(x))]) if self.side_by_side else x[None]
        try:
            residuals = self.residuals_of(points)
        except (RuntimeError, OverflowError):
            return numpy.full(self.rows + len(self.keys), DIVERGED)
        if self.side_by_side:
            self.jacobians = {x.tobytes(): (residuals[1:] - residuals[0]).T / STEP}
        self.last = (x.tobytes(), residuals[0])
        cost = 0.5 * residuals[0] @ residuals[0]
        if cost < self.best[0]:
            self.best = (cost, x.copy())
        self.progress(f"{self.simulations} simulations, mean square {2.0 * cost / len(residuals[0]):.4g} times the noise's")
        return residuals[0]

    def jacobian(self, x):
        if x.tobytes() in self.jacobians:
            return self.jacobians[x.tobytes()]
        here = self.last[1] if self.last[0] == x.tobytes() else self.residuals_of(x[None])[0]
        columns = []
        for step in STEP * numpy.eye(len(x)):
            columns.append((self.residuals_of((x + step)[None])[0] - here) / STEP)
            self.progress(f"{self.simulations} simulations")
        return numpy.array(columns).T

    def run(self):
        """Fits. Returns what it took; `completed` is false where the time was over first."""
        completed = True
        try:
            found = least_squares(self.residual, self.start(), self.jacobian, bounds=(self.lowest(), numpy.inf),
                                  ftol=TOLERANCE, xtol=TOLERANCE, gtol=TOLERANCE, max_nfev=60)
            self.best = (found.cost, found.x)
            completed = bool(found.success)
        except OutOfTime:
            completed = False
        return {"wall_seconds": time.monotonic() - self.began, "processor_seconds": time.process_time() - self.processor_began,
                "simulations": self.simulations, "completed": completed,
                "parameters": {key: float(value) for key, value in self.values(self.best[1]).items()}}
