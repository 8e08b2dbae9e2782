# SPDX-License-Identifier: Apache-2.0
# Compares the instructions that a row takes in the functions of an FMU that set, step and get with those that it takes on the
# same plant in C++, counted by VALGRIND's callgrind:
#   cmake -D PROGRAM=... -D VALGRIND=... -D WORK=... -P fmu_cost.cmake
include(${CMAKE_CURRENT_LIST_DIR}/../model/cost/instructions.cmake)
if(NOT VALGRIND)
  message(STATUS "fmu cost: skipped, valgrind is not installed (apt-get install valgrind)")
  return()
endif()
execute_process(COMMAND ${PROGRAM} unpack ${WORK}/fmu_cost COMMAND_ERROR_IS_FATAL ANY)

set(rows 150)

# counted(RESULT FUNCTIONS ARGUMENT...): instructions inside FUNCTIONS over a run of PROGRAM.
function(counted result functions)
  list(TRANSFORM functions PREPEND --toggle-collect= OUTPUT_VARIABLE toggles)
  set(counts ${WORK}/fmu_cost.callgrind)
  file(REMOVE ${counts})
  execute_process(COMMAND ${CMAKE_COMMAND} -E env LD_BIND_NOW=1 ${VALGRIND} --tool=callgrind --quiet ${toggles}
    --callgrind-out-file=${counts} ${PROGRAM} count ${ARGN} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  file(STRINGS ${counts} line REGEX "^summary: [0-9]+")
  string(REGEX REPLACE "^summary: ([0-9]+).*" "\\1" count "${line}")
  set(${result} ${count} PARENT_SCOPE)
endfunction()

set(failed "")
foreach(topology simplex direct taos masv)
  counted(native hotfire_measured_rows ${topology} plant ${rows})
  math(EXPR native "${native} / ${rows}")
  foreach(version 2 3)
    set(functions fmi2SetReal fmi2DoStep fmi2GetReal)
    if(version EQUAL 3)
      set(functions fmi3SetFloat64 fmi3DoStep fmi3GetFloat64)
    endif()
    counted(fmu "${functions}" ${topology} ${version} ${rows} ${WORK}/fmu_cost)
    math(EXPR fmu "${fmu} / ${rows}")
    quotient(ratio ${fmu} ${native})
    message(STATUS "fmu cost: ${topology}, FMI ${version}: ${fmu} instructions a row, in C++ ${native}, ratio ${ratio}")
    # The calls of an FMU take about 150 instructions, whatever the plant; a mass with one friction takes 1364. An FMU contains
    # the plant: less has counted something else.
    if(NOT ratio LESS 1.12 OR NOT ratio GREATER 0.95)
      string(APPEND failed " ${topology} FMI ${version}: ${ratio};")
    endif()
  endforeach()
endforeach()
if(failed)
  message(FATAL_ERROR "fmu cost: a row through an FMU must take 0.95 to 1.12 of a row in C++:${failed}")
endif()
