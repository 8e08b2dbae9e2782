# SPDX-License-Identifier: Apache-2.0
# Joins the page's parts and the charting library into one HTML text and writes it as a C++ array of bytes.
# cmake -D PARTS=<folder of page.html and page.css> -D SCRIPTS=<names without .js, from that folder, by commas>
#   [-D TEXT=<file that replaces @text@>] -D HEADER=<that declares it> -D FUNCTION=<namespace::name> -D DYGRAPHS=<folder>
#   -D OUTPUT=<page.cpp> -P embed_page.cmake
cmake_policy(VERSION 3.25)

file(READ ${PARTS}/page.html page)
file(READ ${PARTS}/page.css style)
string(REPLACE "," ";" SCRIPTS "${SCRIPTS}")
foreach(name IN LISTS SCRIPTS)
  file(READ ${PARTS}/${name}.js part)
  string(APPEND script "${part}\n")
endforeach()

# The minified file points to its licence by a web address; the licence itself, which the page has to carry, opens the
# plain file.
file(READ ${DYGRAPHS}/dygraph.js plain LIMIT 8000)
if(NOT plain MATCHES "/\\*[^/]*dygraphs is MIT-licenced.*THE SOFTWARE")
  message(FATAL_ERROR "${DYGRAPHS}/dygraph.js does not open with its licence")
endif()
string(FIND "${plain}" "/*" notice_start)
string(FIND "${plain}" "*/" notice_end)
math(EXPR notice_length "${notice_end} + 2 - ${notice_start}")
string(SUBSTRING "${plain}" ${notice_start} ${notice_length} notice)
file(READ ${DYGRAPHS}/dygraph.min.js library)
string(REGEX REPLACE "^/\\*![^\n]*\\*/\n" "" library "${library}")
file(READ ${DYGRAPHS}/extras/synchronizer.js synchronizer)
string(APPEND library "\n${synchronizer}")
string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" library "${library}")
string(REPLACE "https://" "" library "${library}")
file(READ ${DYGRAPHS}/dygraph.min.css library_style)
string(REGEX REPLACE "/\\*#[^\n]*\\*/" "" library_style "${library_style}")

string(REPLACE "@style@" "${library_style}\n${style}" page "${page}")
string(REPLACE "@library@" "${notice}\n${library}" page "${page}")
string(REPLACE "@script@" "${script}" page "${page}")
if(TEXT)
  file(READ ${TEXT} text)
  string(REPLACE "@text@" "${text}" page "${page}")
endif()

get_filename_component(folder ${OUTPUT} DIRECTORY)
file(WRITE ${folder}/page.html "${page}")
file(READ ${folder}/page.html bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
string(REPEAT "." 100 line)
string(REGEX REPLACE "(${line})" "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"${HEADER}\"

namespace {
constexpr unsigned char kBytes[] = {
${bytes}};
}  // namespace

std::string ${FUNCTION}() { return {kBytes, kBytes + sizeof kBytes}; }
")
