# SPDX-License-Identifier: Apache-2.0
# Counts instructions with VALGRIND's callgrind. For the scripts of tests that compare the cost of steps.

# count_instructions(RESULT WORK VALGRIND FUNCTION PROGRAM ARGUMENT...): what each call of FUNCTION in one run of PROGRAM takes,
# as a sorted list in RESULT; what the program printed in RESULT_output.
function(count_instructions result work valgrind function)
  set(counts_file ${work}/${function}.callgrind)
  file(REMOVE ${counts_file})
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env LD_BIND_NOW=1 ${valgrind} --tool=callgrind --quiet --toggle-collect=${function}
            --dump-after=${function} --combine-dumps=yes --callgrind-out-file=${counts_file} ${ARGN}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "counting instructions: ${ARGN} failed with ${status}\n${output}\n${errors}")
  endif()
  # One part a call; what is left at the end of the program is a part without instructions.
  file(STRINGS ${counts_file} lines REGEX "^summary: [0-9]+")
  list(TRANSFORM lines REPLACE "^summary: ([0-9]+).*" "\\1")
  list(REMOVE_ITEM lines 0)
  list(SORT lines COMPARE NATURAL)
  set(${result} ${lines} PARENT_SCOPE)
  set(${result}_output "${output}" PARENT_SCOPE)
endfunction()

# count_memory(RESULT WORK VALGRIND FUNCTION PROGRAM ARGUMENT...): what all calls of FUNCTION in one run of PROGRAM take together,
# on the caches of this machine: RESULT_reads and RESULT_writes of data, RESULT_branches that are conditional, RESULT_mispredicted
# of them, and RESULT_misses of the first cache of data.
function(count_memory result work valgrind function)
  set(counts_file ${work}/${function}.memory)
  file(REMOVE ${counts_file})
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env LD_BIND_NOW=1 ${valgrind} --tool=callgrind --quiet --cache-sim=yes --branch-sim=yes
            --toggle-collect=${function} --callgrind-out-file=${counts_file} ${ARGN}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "counting reads and writes: ${ARGN} failed with ${status}\n${output}\n${errors}")
  endif()
  file(STRINGS ${counts_file} events REGEX "^events: ")
  file(STRINGS ${counts_file} totals REGEX "^(summary|totals): ")
  list(GET totals -1 totals)
  string(REGEX REPLACE "^[a-z]+: " "" events "${events}")
  string(REGEX REPLACE "^[a-z]+: " "" totals "${totals}")
  string(REPLACE " " ";" events "${events}")
  string(REPLACE " " ";" totals "${totals}")
  foreach(event count IN ZIP_LISTS events totals)
    set(of_${event} ${count})
  endforeach()
  math(EXPR misses "${of_D1mr} + ${of_D1mw}")
  set(${result}_reads ${of_Dr} PARENT_SCOPE)
  set(${result}_writes ${of_Dw} PARENT_SCOPE)
  set(${result}_branches ${of_Bc} PARENT_SCOPE)
  set(${result}_mispredicted ${of_Bcm} PARENT_SCOPE)
  set(${result}_misses ${misses} PARENT_SCOPE)
endfunction()

# Quotient of two whole numbers as text with three decimals.
function(quotient result numerator denominator)
  math(EXPR thousandths "${numerator} * 1000 / ${denominator}")
  math(EXPR whole "${thousandths} / 1000")
  math(EXPR part "${thousandths} % 1000 + 1000")
  string(SUBSTRING ${part} 1 3 part)
  set(${result} ${whole}.${part} PARENT_SCOPE)
endfunction()
