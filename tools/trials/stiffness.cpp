// SPDX-License-Identifier: Apache-2.0
#include "tools/trials/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string_view>
#include <type_traits>

#include "model/effects/load/soft_stiffness.hpp"
#include "model/keys.hpp"
#include "tools/files/model/plant_of.hpp"
#include "tools/files/text/error.hpp"
#include "tools/simulate/simulate_vehicle.hpp"

namespace hotfire::trials {

namespace {

using Soft = model::SoftStiffness;

/// Force over deflection of the actuator alone: the model's own law, behind a structure that does not give.
analysis::SpringCurve soft_curve(const Soft::Params<double>& law, double stiffness) {
  return [law, stiffness](double deflection) {
    constexpr double kRigid = 1e30;
    const model::Spring<double> spring{deflection, 0.0, 1.0, 1.0, stiffness, stiffness, kRigid, 1e-3};
    Soft::State<double> state;
    Soft::settle(law, state, spring);
    return Soft::step(law, state, spring).deflection * stiffness;
  };
}

/// `flexibility` is what gives way beside the declared structure at the attach point [m/N].
template <class Parameters>
LoadSpring spring_of(const Parameters& axis, double arm, double flexibility) {
  const double stiffness = axis.actuator.stiffness;
  LoadSpring spring{{axis.engine.inertia, arm, 1.0 / (1.0 / axis.structure.stiffness + flexibility),
                     axis.engine.duct_stiffness, stiffness},
                    [stiffness](double deflection) { return stiffness * deflection; },
                    stiffness};
  model::visit_effects(axis, [&]<class E>(std::size_t index, const auto& law) {
    if constexpr (std::is_same_v<E, Soft>) {
      if (!axis.effects.active[index]) {
        return;
      }
      spring.actuator = soft_curve(law, stiffness);
      if (Soft::options[static_cast<std::size_t>(law.option)] == "table") {
        const auto end = law.table.y.begin() + law.table.points;
        spring.load.actuator_stiffness = *std::max_element(law.table.y.begin(), end);
        spring.loaded = *(end - 1);
      }
    }
  });
  return spring;
}

ResonanceStiffness stiffness_at(const analysis::LoadResonance& load, double amplitude, double frequency) {
  const double total = analysis::total_stiffness(load, frequency);
  return {frequency, analysis::peak_sine_force(load.inertia, load.moment_arm, amplitude, 2.0 * std::numbers::pi * frequency),
          total, analysis::beside(load.load_stiffness, total)};
}

std::string_view topology_of(const ModelFile& model) {
  return std::visit([]<class Parameters>(const Parameters&) { return PlantOf<Parameters, double>::topology; },
                    model.parameters);
}

}  // namespace

LoadSpring load_spring_of(const ModelFile& model) {
  const auto* axis = std::get_if<SimplexParameters>(&model.parameters);
  if (axis == nullptr) {
    throw FileError(
        fmt::format("{}: topology = \"{}\": a mass has no actuator in series with its load; allowed: \"simplex\", "
                    "\"taos\", \"masv\"",
                    model.path.string(), topology_of(model)));
  }
  return spring_of(*axis, axis->actuator.moment_arm, 0.0);
}

LoadSpring load_spring_of(const VehicleFile& model, const std::string& axis) {
  const std::size_t index = axis_index(model, axis);
  return std::visit(
      [&](const auto& parameters) {
        const auto port = static_cast<Eigen::Index>(index);
        double flexibility = parameters.modes.residual(port, port);
        for (int k = 0; k < parameters.modes.modes; ++k) {
          const double w = 2.0 * std::numbers::pi * parameters.modes.frequency[static_cast<std::size_t>(k)];
          flexibility += parameters.modes.shape(port, k) * parameters.modes.shape(port, k) / (w * w);
        }
        // Without its rated thrust a structure is softer than declared.
        const auto& bearing = parameters.gimbals[index / 2].bearing;
        flexibility += bearing.further_structure(bearing.thrust) / parameters.axes[index].structure.stiffness;
        return spring_of(parameters.axes[index], moment_arm_of(model, axis), flexibility);
      },
      model.parameters);
}

std::vector<SineStiffness> sine_stiffnesses(const std::vector<ChannelSweep>& sweeps, const LoadSpring& spring, double bias) {
  std::vector<SineStiffness> stiffnesses;
  for (const ChannelSweep& sweep : sweeps) {
    if (sweep.channel != "piston" || sweep.amplitude <= 0.0) {
      continue;
    }
    SineStiffness own{sweep.amplitude, {}, expected_stiffness(spring, sweep.amplitude, bias)};
    if (sweep.notch) {
      own.test = stiffness_at(spring.load, sweep.amplitude, sweep.notch->frequency);
    }
    stiffnesses.push_back(own);
  }
  return stiffnesses;
}

ResonanceStiffness expected_stiffness(const LoadSpring& spring, double amplitude, double bias) {
  return stiffness_at(spring.load, amplitude, analysis::load_resonance(spring.load, spring.actuator, amplitude, bias));
}

double asymptote(const LoadSpring& spring) {
  return analysis::load_frequency(spring.load, analysis::in_series(spring.loaded, spring.load.load_stiffness));
}

}  // namespace hotfire::trials
