# SPDX-License-Identifier: Apache-2.0
# Counts the instructions of each step of PROGRAM with VALGRIND's callgrind and compares the dearest with the cheapest, and with
# the MOST that a step may take:
# cmake -D PROGRAM=... -D VALGRIND=... -D WORK=... -D MOST=... -P step_cost.cmake
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
if(NOT ratio LESS 1.02)
  message(FATAL_ERROR "step cost: max / min must be below 1.020")
endif()
# Two passes over an axis with three effects multiply 160 numbers and evaluate ten exponentials: fewer has counted something else.
if(most GREATER MOST OR least LESS 1200)
  message(FATAL_ERROR "step cost: a step must take 1200 to ${MOST} instructions")
endif()

count_memory(memory ${WORK} ${VALGRIND} hotfire_measured_step ${PROGRAM})
foreach(count reads writes branches mispredicted misses)
  quotient(${count} ${memory_${count}} 1000)
endforeach()
message(STATUS "step cost: a step reads data ${reads} times and writes ${writes} times, has ${branches} conditional branches "
  "(${mispredicted} mispredicted), and misses the first cache ${misses} times, with another state each time")
