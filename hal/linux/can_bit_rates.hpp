// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace hotfire::hal {

/// The bit rates of a CAN interface [bit/s]; 0: not available, as for a virtual interface or one without FD.
struct CanBitRates {
  double nominal = 0.0;
  double data = 0.0;  ///< of the data of FD frames
};

/// Asks the kernel. Needs no permission; 0 for a rate that is not available. Blocks.
CanBitRates can_bit_rates(const std::string& interface) noexcept;

/// Whether the interface has no wire: vcan or vxcan. False if the kernel does not report it. Blocks.
bool is_virtual_can(const std::string& interface) noexcept;

}  // namespace hotfire::hal
