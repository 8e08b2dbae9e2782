# SPDX-License-Identifier: Apache-2.0
# Four projects of others on the installed library and on the source tree, built with flags that are not ours, and run:
#   cmake -D ROOT=... -D BUILD=... -D SCRATCH=... -P consumers.cmake
cmake_minimum_required(VERSION 3.25)
set(flags "-Wall -Wextra -Wconversion -Werror -O1 -fno-strict-aliasing")

include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

# build(NAME SOURCE OPTION...): configures and builds a project.
function(build name source)
  run(${CMAKE_COMMAND} -G Ninja -S ${source} -B ${SCRATCH}/${name} -DCMAKE_BUILD_TYPE=None "-DCMAKE_C_FLAGS=${flags} -std=c99 -pedantic"
    "-DCMAKE_CXX_FLAGS=${flags}" ${ARGN})
  run(${CMAKE_COMMAND} --build ${SCRATCH}/${name} --target hotfire_example)
endfunction()

file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/installed)
run(${CMAKE_COMMAND} --install ${BUILD} --component sdk --prefix ${prefix})

# 1. find_package, C++ headers.
build(find_package ${ROOT}/examples/axis -DCMAKE_PREFIX_PATH=${prefix})
run(${SCRATCH}/find_package/hotfire_example)
if(NOT output MATCHES "0.50 s +piston +0.0[0-9]+ m +engine +0.0(09|10)")
  message(FATAL_ERROR "the engine does not follow the command:\n${output}")
endif()

# 2. add_subdirectory, with an effect of the project's own.
file(READ ${ROOT}/examples/own_effect/CMakeLists.txt text)
string(REPLACE "find_package(hotfire REQUIRED)" "enable_testing()\nadd_subdirectory(${ROOT} hotfire EXCLUDE_FROM_ALL)" text "${text}")
file(WRITE ${SCRATCH}/own_effect/CMakeLists.txt "${text}")
file(COPY ${ROOT}/examples/own_effect/main.cpp DESTINATION ${SCRATCH}/own_effect)
build(add_subdirectory ${SCRATCH}/own_effect -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
run(${SCRATCH}/add_subdirectory/hotfire_example)
file(READ ${SCRATCH}/add_subdirectory/compile_commands.json commands)
string(REGEX MATCH "\"command\": \"[^\n]*own_effect/main.cpp" command "${commands}")
if(command STREQUAL "")
  message(FATAL_ERROR "no command compiles the example:\n${commands}")
endif()
foreach(ours -Wshadow -Wold-style-cast -ffp-contract -mavx2 EIGEN_MAX_ALIGN "-I${ROOT} " "-isystem ${ROOT} ")
  string(FIND "${command}" "${ours}" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "a consumer is compiled with ${ours}:\n${command}")
  endif()
endforeach()
run(ctest --test-dir ${SCRATCH}/add_subdirectory -N)
if(NOT output MATCHES "Total Tests: 0")
  message(FATAL_ERROR "a consumer gets our tests:\n${output}")
endif()

# 3. pkg-config, without CMake: the headers and the library.
set(ENV{PKG_CONFIG_PATH} ${prefix}/lib/pkgconfig)
file(GLOB found ${prefix}/lib/*/pkgconfig)
if(found)
  set(ENV{PKG_CONFIG_PATH} ${found})
endif()
run(pkg-config --cflags --libs hotfire)
string(STRIP "${output}" library)
run(sh -c "cc ${flags} -std=c99 ${ROOT}/examples/c/main.c ${library} -o ${SCRATCH}/by_pkg_config")
run(pkg-config --cflags eigen3)
string(STRIP "${output}" eigen)
run(pkg-config --cflags hotfire-model)
string(STRIP "${output}" headers)
# Eigen has warnings of its own; ours stay in sight.
string(REPLACE "-I" "-isystem " quiet_eigen "${eigen}")
string(REPLACE "${eigen}" "${quiet_eigen}" headers "${headers}")
run(sh -c "c++ ${flags} -std=c++20 -fsyntax-only ${headers} ${ROOT}/examples/axis/main.cpp")
file(GLOB folder ${prefix}/lib/libhotfire.so ${prefix}/lib/*/libhotfire.so)
cmake_path(GET folder PARENT_PATH folder)
run(${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${folder} ${SCRATCH}/by_pkg_config ${ROOT}/examples/c/axis.toml)

# 4. Plain C by find_package.
build(plain_c ${ROOT}/examples/c -DCMAKE_PREFIX_PATH=${prefix})
run(${SCRATCH}/plain_c/hotfire_example ${ROOT}/examples/c/axis.toml)
if(NOT output MATCHES "0.500 s: engine 0.0(09|10)")
  message(FATAL_ERROR "the engine does not follow the command:\n${output}")
endif()
file(REMOVE_RECURSE ${SCRATCH})
