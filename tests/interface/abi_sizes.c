// SPDX-License-Identifier: Apache-2.0
/* Prints the sizes of the structures of the C interface, for abi.cmake. */
#include <hotfire.h>
#include <stdio.h>

int main(void) {
  printf("sizeof hotfire_options %zu\n", sizeof(hotfire_options));
  printf("sizeof hotfire_variable %zu\n", sizeof(hotfire_variable));
  printf("sizeof hotfire_seed %zu\n", sizeof(hotfire_seed));
  return 0;
}
