// Prints the plant image of the reference axis with every effect active: what `hotfire plant --model` makes of a file, on a
// machine that has no host side.

#include <cstdio>

#include "firmware/reference_plant.hpp"
#include "tools/cli/plant_image_text.hpp"

int main() {
  hotfire::ModelFile model;
  model.parameters = hotfire::firmware::reference_plant_with_every_effect();
  std::fputs(hotfire::plant_image_text(model).c_str(), stdout);
  return 0;
}
