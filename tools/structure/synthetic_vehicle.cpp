// SPDX-License-Identifier: Apache-2.0
// Writes the mode table of the synthetic vehicle that is shipped: synthetic_vehicle > tools/structure/synthetic_vehicle.csv

#include <cstdio>

#include "tools/structure/synthetic.hpp"

int main() {
  const std::string text = hotfire::mode_table_text(
      hotfire::synthetic_vehicle(20230203, 120),
      {"SYNTHETIC vehicle: made by tools/structure/synthetic_vehicle.cpp from a seed, a model of no real vehicle.",
       "Four engines, 120 modes from 1 to 40 Hz, mass-normalised: attach points and strings in kg^-0.5,",
       "gimbals in rad/(m kg^0.5)."});
  return std::fputs(text.c_str(), stdout) >= 0 ? 0 : 1;
}
