// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace hotfire::firmware {

/// Exit statuses of hotfire-rt, those of every command (docs/contract.md).
enum Status { kGood = 0, kBadVerdict = 1, kWrongUse = 2, kHardware = 3, kTiming = 4, kInterlock = 5, kBadData = 6 };

}  // namespace hotfire::firmware
