// SPDX-License-Identifier: Apache-2.0
/* Prints the sizes and members of the structures of the C interface and the values of its constants, for abi.cmake. It does
 * not compile if a function takes or returns other types than a program that was built before expects. */
#include <hotfire.h>
#include <stddef.h>
#include <stdio.h>

typedef struct kept_functions {
  const char* (*version)(void);
  void (*default_options)(hotfire_options*);
  hotfire_status (*open)(const char*, const hotfire_options*, hotfire_model**, char*, size_t);
  hotfire_status (*open_text)(const char*, const char*, const hotfire_options*, hotfire_model**, char*, size_t);
  hotfire_status (*open_plant)(const char*, const char*, hotfire_model**, char*, size_t);
  void (*close)(hotfire_model*);
  const char* (*message)(const hotfire_model*);
  const char* (*topology)(const hotfire_model*);
  size_t (*count)(const hotfire_model*, hotfire_kind);
  hotfire_status (*describe)(hotfire_model*, hotfire_kind, size_t, hotfire_variable*);
  hotfire_status (*find)(hotfire_model*, hotfire_kind, const char*, size_t*);
  hotfire_status (*set)(hotfire_model*, hotfire_kind, const size_t*, const double*, size_t);
  hotfire_status (*get)(hotfire_model*, hotfire_kind, const size_t*, double*, size_t);
  hotfire_status (*start)(hotfire_model*, double);
  hotfire_status (*step)(hotfire_model*);
  double (*time)(const hotfire_model*);
  double (*period)(const hotfire_model*);
  hotfire_status (*differentiate)(hotfire_model*, const hotfire_seed*, size_t, double*, size_t);
  size_t (*state_size)(const hotfire_model*);
  hotfire_status (*save)(hotfire_model*, void*, size_t);
  hotfire_status (*load)(hotfire_model*, const void*, size_t);
} kept_functions;

const kept_functions kept = {hotfire_version,    hotfire_default_options, hotfire_open,       hotfire_open_text,
                             hotfire_open_plant, hotfire_close,           hotfire_message,    hotfire_topology,
                             hotfire_count,      hotfire_describe,        hotfire_find,       hotfire_set,
                             hotfire_get,        hotfire_start,           hotfire_step,       hotfire_time,
                             hotfire_period,     hotfire_differentiate,   hotfire_state_size, hotfire_save,
                             hotfire_load};

/* Where a member is. */
#define AT(type, member) printf("offsetof " #type " " #member " %zu\n", offsetof(type, member))

int main(void) {
  printf("sizeof hotfire_options %zu\n", sizeof(hotfire_options));
  AT(hotfire_options, size);
  AT(hotfire_options, period);
  AT(hotfire_options, seed);
  printf("sizeof hotfire_variable %zu\n", sizeof(hotfire_variable));
  AT(hotfire_variable, name);
  AT(hotfire_variable, unit);
  AT(hotfire_variable, description);
  AT(hotfire_variable, start);
  AT(hotfire_variable, lower);
  AT(hotfire_variable, upper);
  AT(hotfire_variable, tunable);
  printf("sizeof hotfire_seed %zu\n", sizeof(hotfire_seed));
  AT(hotfire_seed, kind);
  AT(hotfire_seed, index);
  AT(hotfire_seed, value);
  printf("statuses %d %d %d %d %d\n", HOTFIRE_OK, HOTFIRE_WRONG_USE, HOTFIRE_BAD_DATA, HOTFIRE_RAN_AWAY, HOTFIRE_NO_MEMORY);
  printf("kinds %d %d %d\n", HOTFIRE_INPUT, HOTFIRE_OUTPUT, HOTFIRE_PARAMETER);
  return kept.version() == NULL;
}
