# SPDX-License-Identifier: Apache-2.0
# For the tests of the checks: runs one over a scratch copy of the tree.

# look(CHECK STATUS OUTPUT ARGUMENT...): exit status and message of tools/style/CHECK.cmake over ${SCRATCH}. CMake wraps its
# messages: here they are one line.
function(look check status output)
  execute_process(COMMAND ${CMAKE_COMMAND} -D ROOT=${SCRATCH} ${ARGN} -P ${ROOT}/tools/style/${check}.cmake
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_VARIABLE text)
  string(REGEX REPLACE "[ \n]+" " " text "${text}")
  set(${status} ${result} PARENT_SCOPE)
  set(${output} "${text}" PARENT_SCOPE)
endfunction()

# expect_words(STATUS OUTPUT WORDS BROKEN): a check that was run over what is BROKEN has failed, and its message has WORDS.
function(expect_words status output words broken)
  string(FIND "${output}" "${words}" position)
  if(status EQUAL 0 OR position EQUAL -1)
    message(SEND_ERROR "${broken}: expected '${words}', got status ${status}: ${output}")
  endif()
endfunction()

# expect_refused(CHECK FILE TEXT WORDS BROKEN): with TEXT in FILE, which is BROKEN then, the check fails and says WORDS. FILE then
# has its old text again; a new one is empty.
function(expect_refused check file text words broken)
  set(old "")
  if(EXISTS ${SCRATCH}/${file})
    file(READ ${SCRATCH}/${file} old)
  endif()
  file(WRITE ${SCRATCH}/${file} "${text}")
  look(${check} status output)
  file(WRITE ${SCRATCH}/${file} "${old}")
  expect_words("${status}" "${output}" "${words}" "${broken}")
endfunction()

# look_at_tree(CHECK): ends the test unless the check passes over the scratch copy as it is.
function(look_at_tree check)
  look(${check} status output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "the tree as it is: ${output}")
  endif()
endfunction()
