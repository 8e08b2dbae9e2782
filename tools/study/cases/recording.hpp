// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/files/record/record.hpp"
#include "tools/study/cases/case.hpp"

namespace hotfire::study {

// Records of one axis: as they are, and as a rig gives them.

/// An axis under a profile: rows read at the times of the commands, the first in equilibrium. What laws may be drawn over is
/// put into `quantities`.
ReferenceRows run(const ReferenceAxis& axis, const Profile& profile, QuantityRows* quantities = nullptr);

/// The kept record, without noise and without what is a fault of a rig's channel: what explained.toml is to predict.
Record unseen_record(const CaseOrder& order, const Profile& profile, const ReferenceRows& rows);

/// What the finder is given, and the stretches of it that the user declares to be wrong ("steps.csv@3.0-3.5").
struct Given {
  std::vector<Record> records;
  std::vector<std::string> exclusions;
};

/// An axis under profiles of the order's condition (`conditioned_profiles`), as sensors read it under that condition.
Given recorded(const CaseOrder& order, const ReferenceAxis& axis, const std::vector<Profile>& profiles);

}  // namespace hotfire::study
