// SPDX-License-Identifier: Apache-2.0
/* The model of a thrust-vector-control actuator as a C library: libhotfire, or the sources of an FMU.
 *
 * A model is made from a model file (docs/contract.md) or its text. It has three tables of numbers: inputs, which are held
 * over a period; outputs, which are read at the end of a period; and parameters. Each number has a name, a unit and a
 * meaning. The same input gives the same bits as `hotfire simulate`.
 *
 *     char message[512];
 *     hotfire_model* model = NULL;
 *     const hotfire_status status = hotfire_open("axis.toml", NULL, &model, message, sizeof message);
 *     if (status != HOTFIRE_OK) { fputs(message, stderr); return status; }
 *     size_t command = 0, engine = 0;
 *     hotfire_find(model, HOTFIRE_INPUT, "command", &command);
 *     hotfire_find(model, HOTFIRE_OUTPUT, "engine", &engine);
 *     hotfire_start(model, 0.0);
 *     for (int i = 0; i < 1000; ++i) {
 *       const double angle = 0.01;
 *       double reading = 0.0;
 *       hotfire_set(model, HOTFIRE_INPUT, &command, &angle, 1);
 *       if (hotfire_step(model) != HOTFIRE_OK) { fputs(hotfire_message(model), stderr); break; }
 *       hotfire_get(model, HOTFIRE_OUTPUT, &engine, &reading, 1);
 *     }
 *     hotfire_close(model);
 *
 * Memory. Only hotfire_open, hotfire_open_text and hotfire_open_plant allocate, and hotfire_close releases it.
 * Everything else takes no memory, no lock and no file.
 *
 * Time. hotfire_set (of inputs), hotfire_get, hotfire_step and hotfire_time take a bounded time that does not depend on the
 * state: they belong in a real-time loop. hotfire_start, hotfire_set of parameters, hotfire_differentiate and a state with
 * other parameters compute constants again: they do not belong there.
 *
 * Threads. A model is used by one thread at a time. Different models are independent of each other, in any number and any
 * threads. hotfire_open and hotfire_open_text wait for each other, because the library of units allows one thread only.
 *
 * Errors. A function that can fail returns a status. hotfire_message has the sentence: what is wrong, the value, and what
 * is allowed; the functions that open a model write it to a buffer of the caller. After an error the model is as it was
 * before the call, except after HOTFIRE_RAN_AWAY. `model` must not be NULL except in hotfire_close. Any other pointer may be
 * NULL where the call says so or its count is 0, and is refused with HOTFIRE_WRONG_USE elsewhere.
 *
 * Licence: Apache-2.0.
 */
#ifndef HOTFIRE_H
#define HOTFIRE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define HOTFIRE_API __attribute__((visibility("default")))
#else
#define HOTFIRE_API
#endif

/* One model in the middle of a run. */
typedef struct hotfire_model hotfire_model;

/* The values of the first three are the exit statuses of the command `hotfire`. */
typedef enum hotfire_status {
  HOTFIRE_OK = 0,
  HOTFIRE_WRONG_USE = 2, /* a call in the wrong order, or an argument that no model can take */
  HOTFIRE_BAD_DATA = 6,  /* a file, a value or a state that this model refuses */
  HOTFIRE_RAN_AWAY = 7,  /* a reading is not finite or beyond 1e12: the parameters are unstable for these inputs */
  HOTFIRE_NO_MEMORY = 8  /* there is not enough memory to open the model */
} hotfire_status;

typedef enum hotfire_kind { HOTFIRE_INPUT = 0, HOTFIRE_OUTPUT = 1, HOTFIRE_PARAMETER = 2 } hotfire_kind;

/* How a model is run. Fill it with hotfire_default_options first, so that a later version may add to it. */
typedef struct hotfire_options {
  size_t size;   /* sizeof(hotfire_options) of the caller */
  double period; /* between two readings [s], 1e-6 to 1; default 1e-3. The model itself takes steps of at most 0.5 ms. */
  uint32_t seed; /* of the noise of the sensors that a vehicle's file declares, and of the places of its strings */
} hotfire_options;

/* One number of a table. The texts live as long as the model. */
typedef struct hotfire_variable {
  const char* name;        /* as in records and model files: "command.pitch", "engine.inertia" */
  const char* unit;        /* UDUNITS-2 text; "1": none; "": follows the unit of the record, for a `direct` mass */
  const char* description; /* one sentence without its full stop */
  double start;            /* value after hotfire_open */
  double lower;            /* allowed from here */
  double upper;            /* to here */
  int tunable;             /* of a parameter: 1 if it may change after hotfire_start */
} hotfire_variable;

/* The change of an input or parameter in a directional derivative. */
typedef struct hotfire_seed {
  hotfire_kind kind; /* HOTFIRE_INPUT or HOTFIRE_PARAMETER */
  size_t index;
  double value;
} hotfire_seed;

/* Version of the library, "0.1.0". */
HOTFIRE_API const char* hotfire_version(void);

HOTFIRE_API void hotfire_default_options(hotfire_options* options);

/* Makes `*model` from a model file. `options` may be NULL. On an error `*model` is NULL and `message` (cut to `size`
 * characters; NULL with 0 for none) has a sentence that names file, line, key, value and remedy. Returns HOTFIRE_WRONG_USE
 * for a missing argument or a refused option, HOTFIRE_BAD_DATA for a refused file, or HOTFIRE_NO_MEMORY. */
HOTFIRE_API hotfire_status hotfire_open(const char* path, const hotfire_options* options, hotfire_model** model,
                                        char* message, size_t size);

/* The same from the text of a model file. `name` represents the file in messages; a mode table is read from beside it. */
HOTFIRE_API hotfire_status hotfire_open_text(const char* text, const char* name, const hotfire_options* options,
                                             hotfire_model** model, char* message, size_t size);

/* The same from a plant text, which `hotfire export` puts into an FMU as resources/plant.txt: a model file with all numbers
 * in SI. Its reader needs neither TOML nor units. The text contains the options. */
HOTFIRE_API hotfire_status hotfire_open_plant(const char* text, const char* name, hotfire_model** model, char* message,
                                              size_t size);

/* Releases the memory. NULL is allowed. */
HOTFIRE_API void hotfire_close(hotfire_model* model);

/* The sentence about the last call of this model that failed; "" if none has. */
HOTFIRE_API const char* hotfire_message(const hotfire_model* model);

/* "simplex", "direct", "taos" or "masv". */
HOTFIRE_API const char* hotfire_topology(const hotfire_model* model);

/* How many numbers a table has. */
HOTFIRE_API size_t hotfire_count(const hotfire_model* model, hotfire_kind kind);

/* Describes one number of a table. */
HOTFIRE_API hotfire_status hotfire_describe(hotfire_model* model, hotfire_kind kind, size_t index,
                                            hotfire_variable* variable);

/* The index of a name in a table. */
HOTFIRE_API hotfire_status hotfire_find(hotfire_model* model, hotfire_kind kind, const char* name, size_t* index);

/* Sets inputs or parameters: all of them, or none if one is refused. A relation between parameters is checked when all are
 * set. A parameter that is not tunable is refused after hotfire_start. */
HOTFIRE_API hotfire_status hotfire_set(hotfire_model* model, hotfire_kind kind, const size_t* indices, const double* values,
                                       size_t count);

/* Reads any table. Outputs are those of the end of the last period; before hotfire_start there are none. */
HOTFIRE_API hotfire_status hotfire_get(hotfire_model* model, hotfire_kind kind, const size_t* indices, double* values,
                                       size_t count);

/* Starts, or starts again, at `time` [s]: hydraulic axes in the steady state under their commands, a `direct` mass at
 * "start.position" with "start.velocity". The noise of the sensors begins again. */
HOTFIRE_API hotfire_status hotfire_start(hotfire_model* model, double time);

/* Advances by one period with the inputs held. */
HOTFIRE_API hotfire_status hotfire_step(hotfire_model* model);

/* Time of the outputs [s], and the period [s]. */
HOTFIRE_API double hotfire_time(const hotfire_model* model);
HOTFIRE_API double hotfire_period(const hotfire_model* model);

/* The directional derivative, by dual numbers: the change of each output at the end of the next period if inputs and
 * parameters change by the seeds, from the present state. `sensitivity` has one place for each output. Noise and
 * quantisation of a reading are left out. The model does not change. */
HOTFIRE_API hotfire_status hotfire_differentiate(hotfire_model* model, const hotfire_seed* seeds, size_t count,
                                                 double* sensitivity, size_t outputs);

/* The state as bytes: inputs, outputs, parameters, time and the memory of the model. They are for the same model, the
 * same version and the same kind of machine; anything else is refused. Bytes may be written to a file. */
HOTFIRE_API size_t hotfire_state_size(const hotfire_model* model);
HOTFIRE_API hotfire_status hotfire_save(hotfire_model* model, void* bytes, size_t size);
HOTFIRE_API hotfire_status hotfire_load(hotfire_model* model, const void* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
