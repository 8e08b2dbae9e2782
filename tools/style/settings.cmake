# SPDX-License-Identifier: Apache-2.0
# Warnings and code generation that every target of the project shares, as the interface target hotfire_settings.
add_library(hotfire_settings INTERFACE)
target_compile_features(hotfire_settings INTERFACE cxx_std_20)
target_include_directories(hotfire_settings INTERFACE ${PROJECT_SOURCE_DIR})
# In another project its own warnings hold.
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(hotfire_settings INTERFACE -Werror -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wcast-align
    -Wcast-qual -Woverloaded-virtual -Wold-style-cast -Wfloat-conversion -Wdouble-promotion -Wformat=2 -Wimplicit-fallthrough
    -Wduplicated-cond -Wduplicated-branches -Wlogical-op -Wundef -Wextra-semi -Wredundant-decls -Wmissing-declarations
    -Wzero-as-null-pointer-constant -Wsuggest-override -Wvla)
  # A build in batches compiles a few sources as one: each is then an included file, and its unnamed namespace is that of a
  # header to this warning.
  if(CMAKE_UNITY_BUILD)
    target_compile_options(hotfire_settings INTERFACE -Wno-subobject-linkage)
  endif()
  # g++ 12 sees an overlap in `"text" + std::string` that is not there (GCC bug 105651); g++ 13 does not.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(hotfire_settings INTERFACE -Wno-restrict)
  endif()
endif()
# Contraction would make the same source give other bits on a machine with fused multiply-add.
target_compile_options(hotfire_settings INTERFACE -ffp-contract=off)
# Eigen aligns its members by the instruction set; a library built for AVX2 and one that is not would disagree on where the
# members of the same class are. 16 is what Debian's Ceres was built with, and costs no time.
target_compile_definitions(hotfire_settings INTERFACE EIGEN_MAX_ALIGN_BYTES=16)

# For the sources that instantiate the model in float: its constants are double literals on purpose, so that the double
# model is exact, and each one is then narrowed.
add_library(hotfire_float_settings INTERFACE)
target_compile_options(hotfire_float_settings INTERFACE -Wno-float-conversion -Wno-double-promotion)

set(HOTFIRE_SANITIZE "" CACHE STRING "Sanitizers to build with, as the compiler names them: address,undefined or thread")
if(HOTFIRE_SANITIZE)
  target_compile_options(hotfire_settings INTERFACE -fsanitize=${HOTFIRE_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(hotfire_settings INTERFACE -fsanitize=${HOTFIRE_SANITIZE})
endif()

# Code that reads, writes and words, and computes nothing at length: more optimisation takes the compiler a third more time and
# saves none. Not for code that steps a plant in double: of a function that several libraries have, the linker takes the first,
# and a lightly optimised one makes every step of the program a third slower.
function(hotfire_optimise_lightly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Without fused multiply-add, which Eigen would use and so round differently from what runs on the target.
option(HOTFIRE_TUNE "Compile the host tools for AVX2 if this machine has it: same bits, faster fits" ON)
add_library(hotfire_host_settings INTERFACE)
target_link_libraries(hotfire_host_settings INTERFACE hotfire_settings)
if(HOTFIRE_TUNE AND PROJECT_IS_TOP_LEVEL)
  include(CheckCXXSourceRuns)
  check_cxx_source_runs("int main() { return __builtin_cpu_supports(\"avx2\") ? 0 : 1; }" HOTFIRE_HOST_HAS_AVX2)
  if(HOTFIRE_HOST_HAS_AVX2)
    target_compile_options(hotfire_host_settings INTERFACE -mavx2)
  endif()
endif()

# hotfire_precompile(TARGET KIND): the headers of most files take the compiler six seconds a batch. A build in batches reads them
# once for the lightly optimised targets of a KIND, which have the same options. Other builds read them where they are included.
set(HOTFIRE_PRECOMPILE OFF)
if(CMAKE_UNITY_BUILD AND NOT HOTFIRE_SANITIZE AND NOT CMAKE_CROSSCOMPILING)
  set(HOTFIRE_PRECOMPILE ON)
endif()
function(hotfire_precompile target kind)
  if(NOT HOTFIRE_PRECOMPILE)
    return()
  endif()
  # g++ refuses headers that were read with a definition that the user of them does not have: their owner has the fewest.
  set(owner hotfire_precompiled_${kind})
  if(NOT TARGET ${owner})
    set(source ${PROJECT_BINARY_DIR}/generated/${owner}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "// Reads the headers.\n")
    add_library(${owner} OBJECT ${source})
    target_link_libraries(${owner} PRIVATE hotfire_host_settings)
    find_package(Eigen3 3.4 REQUIRED NO_MODULE)
    get_target_property(eigen_include Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
    target_include_directories(${owner} SYSTEM PRIVATE ${eigen_include})
    target_precompile_headers(${owner} PRIVATE <Eigen/Dense> <nlohmann/json.hpp> <algorithm> <array> <cmath> <filesystem>
      <fstream> <functional> <map> <memory> <numeric> <optional> <set> <span> <sstream> <string> <tuple> <variant> <vector>)
    hotfire_optimise_lightly(${owner})
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
  # g++ 12 sees a move of a temporary string beyond its end, which it does not say of a header that is not precompiled.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-array-bounds)
  endif()
endfunction()
