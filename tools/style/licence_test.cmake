# SPDX-License-Identifier: Apache-2.0
# Takes the line of the licence out of files of a scratch folder and expects licence.cmake to name each, and to add it.
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${SCRATCH})
set(identifier "SPDX-License-Identifier: Apache-2.0")
# What a file has behind its first line is kept, with everything that CMake takes for a list or a variable.
set(rest "a[1]; \${b} \\n \"c\"\n\nlast")
function(write_file file first)
  file(WRITE ${SCRATCH}/${file} "${first}${rest}")
endfunction()
write_file(model/a.hpp "")
write_file(tools/b.py "")
write_file(tools/c "#!/bin/sh\n")
write_file(tests/CMakeLists.txt "# another comment\n")
write_file(tools/report/d.css "/* ${identifier} */ body")
write_file(CMakeLists.txt "# ${identifier}\n")
# Neither a source nor a script.
write_file(tests/data/e "")
write_file(tests/data/f.csv "")

function(look status output)
  execute_process(COMMAND ${CMAKE_COMMAND} -D ROOT=${SCRATCH} ${ARGN} -P ${ROOT}/tools/style/licence.cmake
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  set(${status} ${result} PARENT_SCOPE)
  set(${output} "${text}" PARENT_SCOPE)
endfunction()

look(status text)
foreach(file model/a.hpp tools/b.py tools/c tests/CMakeLists.txt tools/report/d.css)
  if(status EQUAL 0 OR NOT text MATCHES "\n *${file}\n")
    message(SEND_ERROR "${file} without its licence is not named: ${text}")
  endif()
endforeach()
if(text MATCHES "tests/data|\n *CMakeLists")
  message(SEND_ERROR "a file is named that needs no line: ${text}")
endif()

look(status text -D ADD=ON)
look(status text)
if(NOT status EQUAL 0)
  message(SEND_ERROR "the line was not added: ${text}")
endif()
file(READ ${SCRATCH}/tools/c text)
if(NOT text STREQUAL "#!/bin/sh\n# ${identifier}\n${rest}")
  message(SEND_ERROR "adding the line changed the rest: ${text}")
endif()
