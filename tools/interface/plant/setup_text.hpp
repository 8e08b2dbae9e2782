// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

#include "tools/interface/plant/plant.hpp"

namespace hotfire::plant {

/// A plant text: how the plant is run, then its image (firmware/image/plant_image.hpp). Reading gives the same bits.
///
///     period 0x1.0624dd2f1a9fcp-10
///     seed 1
///     strings no
///     schema 1
///     topology simplex
///     ...
inline std::string setup_text(const Setup& setup, const std::string& image) {
  char period[32];
  std::snprintf(period, sizeof period, "%a", setup.period);
  return std::string("period ") + period + "\nseed " + std::to_string(setup.seed) + "\nstrings " +
         (setup.strings ? "yes" : "no") + "\n" + image;
}

}  // namespace hotfire::plant
