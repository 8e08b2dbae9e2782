# SPDX-License-Identifier: Apache-2.0
# Counts the instructions of each step of PROGRAM with VALGRIND's callgrind and compares the dearest with the cheapest:
# cmake -D PROGRAM=... -D VALGRIND=... -D WORK=... -P step_cost.cmake
include(${CMAKE_CURRENT_LIST_DIR}/instructions.cmake)
if(NOT VALGRIND)
  message(STATUS "step cost: skipped, valgrind is not installed (apt-get install valgrind)")
  return()
endif()

count_instructions(counts ${WORK} ${VALGRIND} hotfire_measured_step ${PROGRAM})
list(LENGTH counts steps)
list(GET counts 0 least)
list(GET counts -1 most)
quotient(ratio ${most} ${least})
message(STATUS "${counts_output}step cost: ${steps} steps, ${least} to ${most} instructions, max / min = ${ratio}")
if(NOT steps EQUAL 1000)
  message(FATAL_ERROR "step cost: 1000 steps were expected, callgrind counted ${steps}")
endif()
if(NOT ratio LESS 1.1)
  message(FATAL_ERROR "step cost: max / min must be below 1.100")
endif()
