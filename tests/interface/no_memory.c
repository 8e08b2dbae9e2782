// SPDX-License-Identifier: Apache-2.0
/* Opens a model when the process may take no more memory, and exits with the status: no_memory model.toml */
#include <hotfire.h>
#include <stdlib.h>
#include <sys/resource.h>

int main(int argc, char** argv) {
  hotfire_model* model = NULL;
  const struct rlimit no_more = {0, 0};
  if (argc != 2 || setrlimit(RLIMIT_AS, &no_more) != 0) {
    return 1;
  }
  /* What the process has free already is taken first. */
  while (malloc(16) != NULL) {
  }
  return hotfire_open(argv[1], NULL, &model, NULL, 0);
}
