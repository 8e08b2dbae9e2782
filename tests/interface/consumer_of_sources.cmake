# SPDX-License-Identifier: Apache-2.0
# A C project that has the source tree as a subfolder: it builds all of it, libhotfire too, with another compiler and flags that
# are not ours, and runs.
#   cmake -D ROOT=... -D SCRATCH=... [-D COMPILER=...] -P consumer_of_sources.cmake
cmake_minimum_required(VERSION 3.25)
set(flags "-Wall -Wextra -O1")
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

file(REMOVE_RECURSE ${SCRATCH})
file(READ ${ROOT}/examples/c/CMakeLists.txt text)
string(REPLACE "find_package(hotfire REQUIRED)" "add_subdirectory(${ROOT} hotfire)" text "${text}")
string(REPLACE "LANGUAGES C)" "LANGUAGES C CXX)" text "${text}")
file(WRITE ${SCRATCH}/CMakeLists.txt "${text}")
file(COPY ${ROOT}/examples/c/main.c DESTINATION ${SCRATCH})
run(${CMAKE_COMMAND} -G Ninja -S ${SCRATCH} -B ${SCRATCH}/build -DCMAKE_BUILD_TYPE=None "-DCMAKE_C_FLAGS=${flags}"
  "-DCMAKE_CXX_FLAGS=${flags}" -DCMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
file(GLOB_RECURSE program ${SCRATCH}/build/hotfire_example)
run(${program} ${ROOT}/examples/c/axis.toml)
if(NOT output MATCHES "0.500 s: engine 0.0(09|10)")
  message(FATAL_ERROR "the engine does not follow the command:\n${output}")
endif()
file(REMOVE_RECURSE ${SCRATCH})
