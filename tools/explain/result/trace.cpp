// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/trace.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tools/explain/data/smoothing.hpp"
#include "tools/explain/data/statistics.hpp"
#include "tools/explain/words/conclusions.hpp"

namespace hotfire::explain {

namespace {

template <class F>
Series by_row(std::size_t rows, F&& f) {
  Series values(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    values[i] = f(i);
  }
  return values;
}

/// What one equation leaves over in one experiment, with the quantities it may depend on.
struct LeftOver {
  std::string equation;
  Quantity missing;
  std::vector<Quantity> around;
};

std::vector<LeftOver> left_over(const Experiment& experiment, const SimplexParameters& p, const Series& piston,
                                const Series& angle) {
  const double period = experiment.period;
  const std::size_t rows = piston.size();
  const double frequency = smoothing_frequency(period);
  const Series x = smoothed(piston, period, frequency);
  const Series beta = smoothed(angle, period, frequency);
  const Series x_rate = rate_of(x, period);
  const Series beta_rate = rate_of(beta, period);
  const Series beta_acceleration = rate_of(beta_rate, period);
  const Series x_acceleration = rate_of(x_rate, period);
  const double arm = p.actuator.moment_arm;
  const double stiffness = 1.0 / (1.0 / p.actuator.stiffness + 1.0 / p.structure.stiffness);
  const Series load = by_row(rows, [&](std::size_t i) { return stiffness * (x[i] - arm * beta[i]); });
  const Series measured = experiment.torque.empty() ? Series(rows) : smoothed(experiment.torque, period, frequency);
  const Series torque = by_row(rows, [&](std::size_t i) {
    return arm * load[i] + measured[i] - p.engine.inertia * beta_acceleration[i] - p.engine.viscous_damping * beta_rate[i] -
           p.engine.duct_stiffness * beta[i];
  });

  const Series pressure = by_row(rows, [&](std::size_t i) {
    return (load[i] + p.actuator.piston_mass * x_acceleration[i] + p.actuator.piston_damping * x_rate[i]) /
           p.actuator.piston_area;
  });
  const Series pressure_rate = rate_of(pressure, period);
  const Series command = smoothed(experiment.input, period, frequency);
  const double w = p.servovalve.natural_frequency;
  double washout = pressure.empty() ? 0.0 : pressure.front();
  Series valve_command(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    washout += p.servovalve.pressure_feedback_corner * (pressure[i] - washout) * period;
    valve_command[i] = std::clamp(p.servovalve.position_gain * (arm * command[i] - p.servovalve.position_feedback * x[i]) -
                                      p.servovalve.pressure_feedback_gain * (pressure[i] - washout),
                                  -1.0, 1.0);
  }
  // Far below its natural frequency the spool follows its command 2 zeta / w later; the command is held for half a row.
  const Series command_rate = rate_of(valve_command, period);
  const double lag = 2.0 * p.servovalve.damping_ratio / w + 0.5 * period;
  const Series opening = by_row(rows, [&](std::size_t i) { return valve_command[i] - lag * command_rate[i]; });
  const Series flow = by_row(rows, [&](std::size_t i) {
    const double direction = opening[i] < 0.0 ? -1.0 : 1.0;
    const double drop = std::max(0.0, 1.0 - direction * pressure[i] / p.actuator.supply_pressure);
    return p.servovalve.rated_flow * opening[i] * std::sqrt(drop) - p.actuator.piston_area * x_rate[i] -
           p.actuator.leakage * pressure[i] - p.actuator.trapped_volume / (4.0 * p.actuator.bulk_modulus) * pressure_rate[i];
  });
  std::vector<Quantity> around{{"engine rate", "rad/s", beta_rate}, {"engine angle", "rad", beta}, {"load", "N", load}};
  if (experiment.other.is_there()) {
    around.push_back({"angle about the other axis", "rad", experiment.other.angle});
  }
  return {{"engine", {"torque against the motion", "N.m", torque}, around},
          {"flow",
           {"missing flow", "m^3/s", flow},
           {{"spool position", "1", opening},
            {"piston rate", "m/s", x_rate},
            {"piston position", "m", x},
            {"load pressure", "Pa", pressure}}}};
}

/// Of a driven mass or a moved body.
std::vector<LeftOver> left_over(const Experiment& experiment, const Series& measured_force, double inertia, double damping,
                                double stiffness, const Series& position) {
  const double period = experiment.period;
  // The smoothing follows the sampling: a direct mass has no bandwidth that is known beforehand.
  const double frequency = 1.0 / (10.0 * period);
  const Series x = smoothed(position, period, frequency);
  const Series force = smoothed(measured_force, period, frequency);
  const Series velocity = rate_of(x, period);
  const Series acceleration = rate_of(velocity, period);
  const Series missing = by_row(x.size(), [&](std::size_t i) {
    return force[i] - inertia * acceleration[i] - damping * velocity[i] - stiffness * x[i];
  });
  return {{"mass",
           {"force against the motion", "force", missing},
           {{"velocity", "position/time", velocity}, {"position", "position", x}}}};
}

/// Share of the variance of y that the mean of y over equal-count bins of x explains.
double correlation_ratio(const Series& x, const Series& y) {
  constexpr std::size_t kBins = 40;
  std::vector<std::size_t> order(x.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  double mean = 0.0;
  for (const double v : y) {
    mean += v / static_cast<double>(y.size());
  }
  double total = 0.0;
  for (const double v : y) {
    total += (v - mean) * (v - mean);
  }
  double between = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const std::size_t first = x.size() * bin / kBins;
    const std::size_t last = x.size() * (bin + 1) / kBins;
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      sum += y[order[i]] - mean;
    }
    if (last > first) {
      between += sum * sum / static_cast<double>(last - first);
    }
  }
  return total > 0.0 ? between / total : 0.0;
}

Series noise_like(std::size_t rows, double rms, std::mt19937_64& generator) {
  std::normal_distribution<double> normal(0.0, rms);
  return by_row(rows, [&](std::size_t) { return normal(generator); });
}

void append(Quantity& all, const Quantity& part, std::size_t edge) {
  all.label = part.label;
  all.unit = part.unit;
  if (part.values.size() > 2 * edge) {
    all.values.insert(all.values.end(), part.values.begin() + static_cast<std::ptrdiff_t>(edge),
                      part.values.end() - static_cast<std::ptrdiff_t>(edge));
  }
}

/// Joins the left-overs of all experiments and finds what each depends on.
template <class Reconstruct>
std::vector<Trace> joined(const Dataset& data, Reconstruct&& of) {
  std::vector<LeftOver> all;
  std::vector<Series> noise;
  std::mt19937_64 generator(20230205);
  for (const Experiment& experiment : data.experiments) {
    const std::vector<LeftOver> part = of(experiment, false, generator);
    const std::vector<LeftOver> floor = of(experiment, true, generator);
    if (part.empty()) {
      continue;
    }
    // The smoothing has no neighbours at a record's ends.
    const auto edge = static_cast<std::size_t>(0.1 / experiment.period) + 2;
    all.resize(part.size());
    noise.resize(part.size());
    for (std::size_t k = 0; k < part.size(); ++k) {
      all[k].equation = part[k].equation;
      append(all[k].missing, part[k].missing, edge);
      all[k].around.resize(part[k].around.size());
      for (std::size_t q = 0; q < part[k].around.size(); ++q) {
        append(all[k].around[q], part[k].around[q], edge);
      }
      noise[k].insert(noise[k].end(), floor[k].missing.values.begin(), floor[k].missing.values.end());
    }
  }
  std::vector<Trace> traces;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].missing.values.empty()) {
      continue;
    }
    Trace trace;
    trace.equation = all[k].equation;
    trace.missing = all[k].missing;
    const double floor = root_mean_square(noise[k]);
    trace.signal_to_noise = floor > 0.0 ? root_mean_square(trace.missing.values) / floor : 0.0;
    for (const Quantity& quantity : all[k].around) {
      const double share = correlation_ratio(quantity.values, trace.missing.values);
      if (share > trace.share) {
        trace.share = share;
        trace.depends_on = quantity;
      }
    }
    traces.push_back(std::move(trace));
  }
  std::sort(traces.begin(), traces.end(),
            [](const Trace& a, const Trace& b) { return a.signal_to_noise > b.signal_to_noise; });
  return traces;
}

std::vector<Trace> reconstruct_with(const Dataset& data, const SimplexParameters& parameters) {
  return joined(data, [&](const Experiment& experiment, bool noise_only, std::mt19937_64& generator) {
    if (experiment.measured[0].empty() || experiment.measured[1].empty()) {
      return std::vector<LeftOver>{};
    }
    if (!noise_only) {
      return left_over(experiment, parameters, experiment.measured[0], experiment.measured[1]);
    }
    Experiment still = experiment;
    still.input.assign(experiment.rows(), 0.0);
    still.torque.clear();
    return left_over(still, parameters, noise_like(experiment.rows(), experiment.noise[0], generator),
                     noise_like(experiment.rows(), experiment.noise[1], generator));
  });
}

std::vector<Trace> reconstruct_with(const Dataset& data, const DirectParameters& parameters) {
  const auto& mass = parameters.mass;
  return joined(data, [&](const Experiment& experiment, bool noise_only, std::mt19937_64& generator) {
    if (!noise_only) {
      return left_over(experiment, experiment.input, mass.inertia, mass.damping, mass.stiffness, position_of(experiment));
    }
    Experiment still = experiment;
    still.input.assign(experiment.rows(), 0.0);
    for (std::size_t c = 0; c < still.measured.size(); ++c) {
      if (!still.measured[c].empty()) {
        still.measured[c] = noise_like(experiment.rows(), experiment.noise[c], generator);
      }
    }
    return left_over(still, still.input, mass.inertia, mass.damping, mass.stiffness, position_of(still));
  });
}

std::vector<Trace> reconstruct_with(const Dataset& data, const ImposedMotionParameters& parameters) {
  const auto& body = parameters.body;
  return joined(data, [&](const Experiment& experiment, bool noise_only, std::mt19937_64& generator) {
    if (!noise_only) {
      return left_over(experiment, experiment.measured[0], body.inertia, body.damping, body.stiffness, experiment.input);
    }
    const Series still(experiment.rows(), 0.0);
    return left_over(experiment, noise_like(experiment.rows(), experiment.noise[0], generator), body.inertia, body.damping,
                     body.stiffness, still);
  });
}

/// What acts in a joint does not follow from the motion of other places without the modes.
std::vector<Trace> reconstruct_with(const Dataset&, const ModalParameters&) { return {}; }

/// Motor and load need not both be measured.
std::vector<Trace> reconstruct_with(const Dataset&, const ElectromechanicalParameters&) { return {}; }

}  // namespace

std::vector<Trace> reconstruct(const Dataset& data, const ModelParameters& parameters) {
  return std::visit([&](const auto& own) { return reconstruct_with(data, own); }, parameters);
}

std::string in_words(const Trace& trace) {
  constexpr double kLeastShare = 0.05;
  return words::trace(trace.equation, trace.missing.label, root_mean_square(trace.missing.values), trace.missing.unit,
                      trace.signal_to_noise) +
         " " +
         (trace.share < kLeastShare ? words::trace_depends_on_none()
                                    : words::trace_depends(trace.depends_on.label, trace.share));
}

}  // namespace hotfire::explain
