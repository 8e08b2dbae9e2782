// SPDX-License-Identifier: Apache-2.0
#include "tools/study/cases/orders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/files/text/error.hpp"

namespace hotfire::study {
namespace {

/// What is missing in each case of a study, before seeds.
using Kinds = std::vector<std::vector<std::string>>;

std::string name_of(const std::vector<std::string>& effects) { return fmt::format("{}", fmt::join(effects, "+")); }

std::vector<CaseOrder> orders_of(const Kinds& kinds, const Selection& selection) {
  for (const std::string& name : selection.only) {
    if (std::none_of(kinds.begin(), kinds.end(), [&](const auto& effects) { return name_of(effects) == name; })) {
      std::string names;
      for (const auto& effects : kinds) {
        names += (names.empty() ? "" : ", ") + name_of(effects);
      }
      throw UsageError(fmt::format("--only {}: this study has no such case; it has {}", name, names));
    }
  }
  std::vector<CaseOrder> orders;
  for (std::uint64_t seed = selection.first_seed; seed < selection.first_seed + selection.seeds; ++seed) {
    for (const auto& effects : kinds) {
      const std::string name = name_of(effects);
      if (selection.only.empty() || std::find(selection.only.begin(), selection.only.end(), name) != selection.only.end()) {
        orders.push_back({fmt::format("{}-{}", name, seed), effects, seed});
      }
    }
  }
  return orders;
}

Kinds each_of(std::span<const StudiedEffect> effects) {
  Kinds kinds;
  for (const StudiedEffect& effect : effects) {
    kinds.push_back({std::string(effect.name)});
  }
  return kinds;
}

}  // namespace

std::vector<CaseOrder> effect_orders(const Selection& selection) { return orders_of(each_of(listed_effects()), selection); }

std::vector<CaseOrder> unlisted_orders(const Selection& selection) {
  return orders_of(each_of(unlisted_effects()), selection);
}

std::vector<CaseOrder> pair_orders(const Selection& selection) {
  Kinds kinds;
  for (const auto& [first, second] : studied_pairs()) {
    kinds.push_back({std::string(first), std::string(second)});
  }
  return orders_of(kinds, selection);
}

std::vector<CaseOrder> two_axis_orders(const Selection& selection) {
  // One other effect a seed, on one axis; the list comes round.
  constexpr std::array kOthers{"gimbal_friction", "soft_stiffness", "valve_deadband",
                               "piston_friction", "backlash",       "command_delay"};
  std::vector<CaseOrder> orders;
  for (std::uint64_t seed = selection.first_seed; seed < selection.first_seed + selection.seeds; ++seed) {
    const std::string other = fmt::format("{}.{}", kOthers[(seed - 1) % kOthers.size()], seed % 2 == 0 ? "pitch" : "yaw");
    const std::string hose = fmt::format("{}.{}", kCrossHose, seed % 2 == 0 ? "yaw" : "pitch");
    Selection one = selection;
    one.first_seed = seed;
    one.seeds = 1;
    one.only.clear();
    for (CaseOrder order : orders_of({{"cross_axis.pitch"}, {"cross_axis.yaw"}, {hose}, {other}, {}}, one)) {
      const std::string name = order.effects.empty() ? "null" : name_of(order.effects);
      if (!selection.only.empty() && std::find(selection.only.begin(), selection.only.end(), name) == selection.only.end()) {
        continue;
      }
      order.name = fmt::format("two-axes-{}-{}", name, seed);
      order.two_axes = true;
      orders.push_back(std::move(order));
    }
  }
  if (orders.empty()) {
    throw UsageError(
        "--only: this study has no such case; it has cross_axis.pitch, cross_axis.yaw, null and, by seed, cross_hose and "
        "another effect on an axis");
  }
  return orders;
}

std::vector<CaseOrder> hard_orders(const Selection& selection) {
  // Effects that show under every condition; each meets another one with every seed.
  constexpr std::array kEffects{"gimbal_friction", "soft_stiffness", "valve_deadband",
                                "command_delay",   "backlash",       "leakage"};
  for (const std::string& name : selection.only) {
    condition_of(name);
  }
  std::vector<CaseOrder> orders;
  for (std::uint64_t seed = selection.first_seed; seed < selection.first_seed + selection.seeds; ++seed) {
    std::size_t next = seed - 1;
    for (const Condition& condition : hard_conditions()) {
      const std::string effect = kEffects[next++ % kEffects.size()];
      if (!selection.only.empty() &&
          std::find(selection.only.begin(), selection.only.end(), condition.name) == selection.only.end()) {
        continue;
      }
      for (const std::vector<std::string>& effects : Kinds{{effect}, {}}) {
        CaseOrder order{fmt::format("{}-{}-{}", condition.name, effects.empty() ? "null" : effect, seed), effects, seed};
        order.condition = condition.name;
        orders.push_back(std::move(order));
      }
    }
  }
  return orders;
}

std::vector<CaseOrder> wild_orders(const Selection& selection, bool beside_a_listed_one) {
  std::vector<CaseOrder> orders;
  for (std::uint64_t seed = selection.first_seed; seed < selection.first_seed + selection.seeds; ++seed) {
    std::vector<std::string> effects;
    if (beside_a_listed_one) {
      const auto listed = listed_effects();
      Random random("listed beside wild", seed);
      const auto at = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(listed.size())));
      effects.emplace_back(listed[std::min(at, listed.size() - 1)].name);
    }
    effects.emplace_back(kWild);
    orders.push_back({fmt::format("{}-{}", name_of(effects), seed), effects, seed});
  }
  return orders;
}

std::vector<CaseOrder> null_orders(const Selection& selection) {
  std::vector<CaseOrder> orders;
  for (std::uint64_t seed = selection.first_seed; seed < selection.first_seed + selection.seeds; ++seed) {
    Random random("null levels", seed);
    const double noise = random.log_uniform(0.5, 5.0);
    const double scatter = random.log_uniform(0.5, 2.0);
    orders.push_back({fmt::format("null-{}", seed), {}, seed, noise, scatter});
  }
  return orders;
}

}  // namespace hotfire::study
