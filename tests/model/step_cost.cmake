# Counts the instructions of each step of PROGRAM with VALGRIND's callgrind and compares the dearest with the cheapest:
# cmake -D PROGRAM=... -D VALGRIND=... -D WORK=... -P step_cost.cmake
if(NOT VALGRIND)
  message(STATUS "step cost: skipped, valgrind is not installed (apt-get install valgrind)")
  return()
endif()

set(counts_file ${WORK}/step_cost.callgrind)
file(REMOVE ${counts_file})
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env LD_BIND_NOW=1 ${VALGRIND} --tool=callgrind --quiet --toggle-collect=hotfire_measured_step --dump-after=hotfire_measured_step
          --combine-dumps=yes --callgrind-out-file=${counts_file} ${PROGRAM}
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "step cost: the program failed with ${result}\n${output}\n${errors}")
endif()

# One part a step; what is left at the end of the program is a part without instructions.
file(STRINGS ${counts_file} lines REGEX "^summary: [0-9]+")
list(TRANSFORM lines REPLACE "^summary: ([0-9]+).*" "\\1")
list(REMOVE_ITEM lines 0)
list(LENGTH lines steps)
list(SORT lines COMPARE NATURAL)
list(GET lines 0 least)
list(GET lines -1 most)
math(EXPR thousandths "${most} * 1000 / ${least}")
math(EXPR whole "${thousandths} / 1000")
math(EXPR part "${thousandths} % 1000 + 1000")
string(SUBSTRING ${part} 1 3 part)
message(STATUS "${output}step cost: ${steps} steps, ${least} to ${most} instructions, max / min = ${whole}.${part}")
if(NOT steps EQUAL 1000)
  message(FATAL_ERROR "step cost: 1000 steps were expected, callgrind counted ${steps}")
endif()
if(NOT thousandths LESS 1100)
  message(FATAL_ERROR "step cost: max / min must be below 1.100")
endif()
