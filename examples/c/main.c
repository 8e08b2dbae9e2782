// SPDX-License-Identifier: Apache-2.0
/* A model file, stepped through a command of 10 mrad, and what the engine's inertia does to its angle: libhotfire from C.
 *   hotfire_example model.toml
 */
#include <hotfire.h>

#include <stdio.h>

int main(int argc, char** argv) {
  char message[512];
  if (argc != 2) {
    fputs("usage: hotfire_example model.toml\n", stderr);
    return 2;
  }
  hotfire_model* model = NULL;
  const hotfire_status opened = hotfire_open(argv[1], NULL, &model, message, sizeof message);
  if (opened != HOTFIRE_OK) {
    fprintf(stderr, "%s\n", message);
    return (int)opened;
  }
  size_t command = 0;
  size_t engine = 0;
  size_t inertia = 0;
  if (hotfire_find(model, HOTFIRE_INPUT, "command", &command) != HOTFIRE_OK ||
      hotfire_find(model, HOTFIRE_OUTPUT, "engine", &engine) != HOTFIRE_OK ||
      hotfire_find(model, HOTFIRE_PARAMETER, "engine.inertia", &inertia) != HOTFIRE_OK) {
    fprintf(stderr, "%s\n", hotfire_message(model));
    hotfire_close(model);
    return 2;
  }
  const double angle = 0.010;
  hotfire_status status = hotfire_start(model, 0.0);
  if (status == HOTFIRE_OK) {
    status = hotfire_set(model, HOTFIRE_INPUT, &command, &angle, 1);
  }
  for (int period = 0; status == HOTFIRE_OK && period < 500; ++period) {
    status = hotfire_step(model);
  }
  double reading = 0.0;
  double sensitivity[3] = {0.0, 0.0, 0.0};
  const hotfire_seed seed = {HOTFIRE_PARAMETER, inertia, 1.0};
  if (status == HOTFIRE_OK) {
    status = hotfire_get(model, HOTFIRE_OUTPUT, &engine, &reading, 1);
  }
  if (status == HOTFIRE_OK) {
    status = hotfire_differentiate(model, &seed, 1, sensitivity, 3);
  }
  if (status != HOTFIRE_OK) {
    fprintf(stderr, "%s\n", hotfire_message(model));
    hotfire_close(model);
    return (int)status;
  }
  printf("%.3f s: engine %.6f rad; one more period moves it by %.3g rad per kg.m^2\n", hotfire_time(model), reading,
         sensitivity[engine]);
  hotfire_close(model);
  return 0;
}
