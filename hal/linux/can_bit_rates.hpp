// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace hotfire::hal {

/// How fast a CAN interface is set up to be [bit/s]; 0: it does not say, as a virtual one, or one without FD.
struct CanBitRates {
  double nominal = 0.0;
  double data = 0.0;  ///< of the data of FD frames
};

/// Asks the kernel. Needs no permission; 0 for what cannot be had. Blocks.
CanBitRates can_bit_rates(const std::string& interface) noexcept;

/// Whether the interface is one without a wire: vcan or vxcan. False if the kernel does not say so. Blocks.
bool is_virtual_can(const std::string& interface) noexcept;

}  // namespace hotfire::hal
