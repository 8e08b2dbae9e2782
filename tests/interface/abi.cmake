# SPDX-License-Identifier: Apache-2.0
# The binary interface of libhotfire against the kept list abi.txt: exported names, SONAME, sizes and members of the structures,
# values of the constants. The types of the functions are checked where abi_sizes.c is compiled.
#   cmake -D LIBRARY=... -D SIZES=... -D KEPT=... -P abi.cmake
cmake_minimum_required(VERSION 3.25)
execute_process(COMMAND nm -D --defined-only ${LIBRARY} OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND readelf -d ${LIBRARY} OUTPUT_VARIABLE dynamic COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${SIZES} OUTPUT_VARIABLE sizes COMMAND_ERROR_IS_FATAL ANY)
set(found "")
string(REGEX MATCHALL "[^\n]+\n" lines "${names}")
foreach(line IN LISTS lines)
  if(NOT line MATCHES " A HOTFIRE_0")
    string(REGEX REPLACE "^[0-9a-f]+ . ([^@\n]*).*" "\\1\n" name "${line}")
    string(APPEND found "${name}")
  endif()
endforeach()
string(REGEX MATCH "SONAME[^[]*\\[([^]]*)\\]" matched "${dynamic}")
string(APPEND found "soname ${CMAKE_MATCH_1}\n${sizes}")
file(READ ${KEPT} kept)
if(NOT found STREQUAL kept)
  message(FATAL_ERROR "the binary interface has changed; raise SOVERSION if a caller can break, and keep the new list in ${KEPT}:\n${found}")
endif()
