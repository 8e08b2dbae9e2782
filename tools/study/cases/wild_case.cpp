// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "tools/study/cases/case_parts.hpp"
#include "tools/study/cases/recording.hpp"
#include "tools/study/draws/wild_draw.hpp"

namespace hotfire::study {
namespace {

/// What the law alone does to the loudest channel, in sensor noise: at least this, so that a person sees it, at most that.
constexpr double kSmallestWild = 3.0;
constexpr double kLargestWild = 75.0;
/// Laws that are drawn before a seed is given up, and sizes that are tried of each.
constexpr std::uint64_t kLaws = 40;
constexpr int kSizes = 4;
/// A change of the law by a thousandth must not change the unseen record by more than half of the noise: of what is drawn
/// nothing is chaotic, so that the true law, fitted, would predict it.
constexpr double kNudge = 1.001;
constexpr double kMostMoved = 0.5;

double loudest(const ReferenceRows& a, const ReferenceRows& b, double noise_factor) {
  double most = 0.0;
  for (std::size_t c = 0; c < 2; ++c) {
    const double size = rms_of_difference(a, b, c) / (kSensorGrades[c].noise * noise_factor);
    most = std::isfinite(size) ? std::max(most, size) : std::numeric_limits<double>::infinity();
  }
  return most;
}

ReferenceAxis with_law(ReferenceAxis axis, const WildLaw& law) {
  axis.wild = std::make_shared<const WildLaw>(law);
  return axis;
}

/// The play between torque motor and spool follows what the torque motor asks by its rate, which a drawn law does not
/// determine.
bool can_be_together(const ReferenceAxis& axis, const WildLaw& law) {
  return axis.play == 0.0 || (law.site != WildSite::command && law.site != WildSite::valve_command);
}

bool is_predictable(const ReferenceAxis& base, WildLaw law, const Profile& unseen, const ReferenceRows& rows,
                    double noise_factor) {
  law.amplitude *= kNudge;
  return loudest(run(with_law(base, law), unseen), rows, noise_factor) < kMostMoved;
}

/// The law at a size at which it shows as it should; none if it has no such size or makes the axis unstable.
std::optional<WildLaw> sized(const ReferenceAxis& base, WildLaw law, double target, const Profile& unseen,
                             const ReferenceRows& base_rows, double noise_factor) {
  try {
    for (int i = 0; i < kSizes; ++i) {
      const ReferenceRows rows = run(with_law(base, law), unseen);
      const double size = loudest(rows, base_rows, noise_factor);
      const bool near = size > 0.5 * target && size < 2.0 * target;
      if (size >= kSmallestWild && size <= kLargestWild && (near || i + 1 == kSizes)) {
        return is_predictable(base, law, unseen, rows, noise_factor) ? std::optional(law) : std::nullopt;
      }
      if (!std::isfinite(size)) {
        return std::nullopt;
      }
      law = resized(law, std::clamp(target / size, 0.03, 30.0));
    }
  } catch (const std::runtime_error&) {
    // CVODE gave up: no axis that a rig would run.
  }
  return std::nullopt;
}

}  // namespace

void add_wild_law(const CaseOrder& order, const Profile& unseen, StudyCase& made) {
  const ReferenceAxis base = made.plan.axis;
  QuantityRows quantities;
  const ReferenceRows base_rows = run(base, unseen, &quantities);
  const WildScales scales(quantities);
  for (std::uint64_t draw = 0; draw < kLaws; ++draw) {
    Random random("wild law/" + order.name, order.seed, 200 + draw);
    const WildLaw drawn = draw_wild_law(random, base, scales);
    const double target = random.log_uniform(1.5 * kSmallestWild, kLargestWild / 1.5);
    if (!can_be_together(base, drawn)) {
      continue;
    }
    if (const auto law = sized(base, drawn, target, unseen, base_rows, order.noise_factor)) {
      made.plan.axis = with_law(base, *law);
      made.plan.in_model_terms = false;
      made.plan.law += (made.plan.law.empty() ? "" : " and ") + words_of(*law);
      made.plan.values["wild.amplitude"] = law->amplitude;
      made.plan.values["wild.draw"] = static_cast<double>(draw);
      return;
    }
  }
  throw std::runtime_error(fmt::format("{}: none of {} laws drawn shows at {} to {} times the sensor noise", order.name,
                                       kLaws, kSmallestWild, kLargestWild));
}

}  // namespace hotfire::study
