# SPDX-License-Identifier: Apache-2.0
# Breaks each rule of safety_case.cmake once, in a scratch copy of what it reads, and expects a fault.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/look.cmake)

function(copy_tree)
  file(REMOVE_RECURSE ${SCRATCH})
  file(COPY ${ROOT}/docs/safety-case.md ${ROOT}/docs/faults.md DESTINATION ${SCRATCH}/docs)
  file(COPY ${ROOT}/firmware/interlock/faults.hpp DESTINATION ${SCRATCH}/firmware/interlock)
  file(COPY ${ROOT}/tests/rig/cases DESTINATION ${SCRATCH}/tests/rig)
  file(COPY ${ROOT}/tests DESTINATION ${SCRATCH} FILES_MATCHING PATTERN "*_test.cpp" PATTERN "CMakeLists.txt")
endfunction()

# expect_fault(FILE BEFORE AFTER WORDS): with BEFORE replaced by AFTER in FILE the check fails, and says WORDS.
function(expect_fault file before after words)
  file(READ ${SCRATCH}/${file} whole)
  string(REGEX REPLACE "${before}" "${after}" broken "${whole}")
  if(broken STREQUAL whole)
    message(SEND_ERROR "${file} has no '${before}'")
  endif()
  expect_refused(safety_case ${file} "${broken}" "${words}" "${file} with '${after}'")
endfunction()

copy_tree()
look_at_tree(safety_case)

set(page docs/safety-case.md)
expect_fault(${page} "`service_sandbox`" "" "R19 has no test")
expect_fault(${page} "`service_sandbox`" "`service_sandpit`" "R19: no test service_sandpit")
expect_fault(${page} "`Interlock.StartsSafeAndDrivesNothing`" "`Interlock.StartsSomehow`" "R1: no test Interlock.StartsSomehow")
expect_fault(tests/firmware/interlock/interlock_test.cpp "TEST.Interlock, StartsSafeAndDrivesNothing." "TEST(Interlock, Other)"
  "R1: no test Interlock.StartsSafeAndDrivesNothing")
expect_fault(${page} "`tools/rig can_refusals`" "`tools/rig nothing`" "R26: no case tests/rig/cases/nothing")
expect_fault(${page} "H6 H8 \\| \\| `service" "H99 | | `service" "R19 is against H99, which is no hazard")
expect_fault(${page} "H6 H8 \\| \\| `service" " | | `service" "R19 is against no hazard")
expect_fault(${page} "\n. R20 " "\n| R19 " "R19 is there twice")
expect_fault(${page} "\n. R19 [^\n]*" "\n| R19 | half a row |" "not | requirement | text |")
expect_fault(${page} "\n. R9 [^\n]*" "" "fault 12, position_error: no requirement")
expect_fault(${page} "H3 . 12 ." "H3 | 12 250 |" "fault 250 of docs/safety-case.md is none")
expect_fault(docs/faults.md "\n## 12 [^\n]*" "\n## position error" "fault 12, position_error: no page in docs/faults.md")
expect_fault(firmware/interlock/faults.hpp "recorder_full = 15," "recorder_full = 15,\n  torn_hose = 250,"
  "fault 250, torn_hose: no page in docs/faults.md")
