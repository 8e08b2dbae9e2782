# SPDX-License-Identifier: Apache-2.0
# Writes text files as a C++ function that gives a text by its file name:
#   cmake -D FILES=<paths by commas> -D HEADER=<that declares it> -D FUNCTION=<namespace::name> -D OUTPUT=<file.cpp>
#     -P embed_templates.cmake
cmake_policy(VERSION 3.25)

string(REPLACE "," ";" FILES "${FILES}")
foreach(path IN LISTS FILES)
  get_filename_component(name ${path} NAME)
  file(READ ${path} text)
  string(APPEND branches "  if (name == \"${name}\") {\n    return R\"~(${text})~\";\n  }\n")
endforeach()
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

std::string_view ${FUNCTION}(std::string_view name) {
${branches}  return {};
}
")
