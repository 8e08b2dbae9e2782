// SPDX-License-Identifier: Apache-2.0
#include "tools/export/documentation.hpp"

#include <fmt/format.h>

#include <string_view>

#include "tools/files/exchange/xml_text.hpp"

namespace hotfire {

namespace {

std::string rows_of(std::string_view kind, const std::vector<plant::Variable>& variables) {
  std::string rows;
  for (const plant::Variable& variable : variables) {
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", kind, escaped(variable.name),
                        escaped(variable.unit), escaped(variable.description));
  }
  return rows;
}

}  // namespace

std::string documentation_page(const plant::Plant& plant, const FmuIdentity& identity) {
  return fmt::format(R"(<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>{name}</title></head>
<body>
<h1>{name}</h1>
<p>A thrust-vector-control actuator, topology {topology}, for co-simulation by FMI {version}.0. Hotfire {hotfire} wrote it.</p>
<p>The internal step is {period} s. Inputs are held over an internal step, and outputs are those of the last one.</p>
<table>
<tr><th></th><th>name</th><th>unit</th><th>meaning</th></tr>
{rows}</table>
<h2>Sources</h2>
<p>The folder sources/ builds the binary for another target:</p>
<pre>cmake -S sources -B build -DCMAKE_BUILD_TYPE=Release &amp;&amp; cmake --build build</pre>
<p>or, with any compiler of C++20:</p>
<pre>cd sources
c++ -std=c++20 -O2 -ffp-contract=off -DFMI{version}_OVERRIDE_FUNCTION_PREFIX -fPIC -shared -I. fmu.cpp -o {identifier}.so</pre>
<p>Without FMI{version}_OVERRIDE_FUNCTION_PREFIX every function begins with {identifier}_, for static linking.</p>
<p><a href="licenses/license.txt">Licence</a>, <a href="licenses/third-party.txt">licences of what it contains</a>,
<a href="externalDependencies.txt">what the binary needs</a></p>
</body>
</html>
)",
                     fmt::arg("name", escaped(identity.name)), fmt::arg("topology", plant.topology()),
                     fmt::arg("version", identity.version), fmt::arg("hotfire", HOTFIRE_VERSION),
                     fmt::arg("period", plant.period()), fmt::arg("identifier", identity.identifier),
                     fmt::arg("rows", rows_of("input", plant.inputs()) + rows_of("output", plant.outputs())));
}

std::string external_dependencies() {
  return "The binary for x86_64 Linux needs the GNU C library 2.36 or later (libc.so.6, libm.so.6), and nothing else.\n"
         "The sources need a compiler of C++20 and its standard library.\n";
}

std::string cmake_project(const FmuIdentity& identity) {
  return fmt::format(
      R"(# Builds the binary of this FMU: cmake -S sources -B build -DCMAKE_BUILD_TYPE=Release && cmake --build build
cmake_minimum_required(VERSION 3.12)
project({identifier} CXX)
add_library({identifier} MODULE fmu.cpp)
set_target_properties({identifier} PROPERTIES PREFIX "" CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF
  CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
target_include_directories({identifier} PRIVATE ${{CMAKE_CURRENT_SOURCE_DIR}})
target_compile_definitions({identifier} PRIVATE FMI{version}_OVERRIDE_FUNCTION_PREFIX)
if(NOT MSVC)
  # Contraction would round otherwise than the model elsewhere.
  target_compile_options({identifier} PRIVATE -ffp-contract=off)
endif()
)",
      fmt::arg("identifier", identity.identifier), fmt::arg("version", identity.version));
}

}  // namespace hotfire
