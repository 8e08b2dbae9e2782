# SPDX-License-Identifier: Apache-2.0
# Writes replaced words into a scratch copy of the pages and the sources, and expects english.cmake to name each.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/look.cmake)

function(copy_tree)
  file(REMOVE_RECURSE ${SCRATCH})
  file(COPY ${ROOT}/README.md ${ROOT}/CONTRIBUTING.md ${ROOT}/CHANGELOG.md DESTINATION ${SCRATCH})
  file(COPY ${ROOT}/examples/README.md DESTINATION ${SCRATCH}/examples)
  file(COPY ${ROOT}/docs DESTINATION ${SCRATCH} FILES_MATCHING PATTERN "*.md")
  foreach(folder model hal firmware tools examples)
    file(COPY ${ROOT}/${folder} DESTINATION ${SCRATCH} FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h" PATTERN "*.cpp" PATTERN "*.js"
      PATTERN "*.py")
  endforeach()
endfunction()

# expect_fault(FILE TEXT FAULT): with TEXT at the end of FILE the check fails, and its message has FAULT.
function(expect_fault file text fault)
  set(old "")
  if(EXISTS ${SCRATCH}/${file})
    file(READ ${SCRATCH}/${file} old)
  endif()
  expect_refused(english ${file} "${old}${text}\n" "${fault}" "${file} with '${text}'")
endfunction()

# expect_none(FILE TEXT): a new FILE with TEXT is allowed.
function(expect_none file text)
  file(WRITE ${SCRATCH}/${file} "${text}\n")
  look(english status output)
  file(REMOVE ${SCRATCH}/${file})
  if(NOT status EQUAL 0)
    message(SEND_ERROR "${file} with '${text}' is allowed, but: ${output}")
  endif()
endfunction()

copy_tree()
look_at_tree(english)

expect_fault(docs/wrong.md "# A page\n\nThe effect is told by the record." "docs/wrong.md:3: 'told', write: identified")
expect_fault(docs/trials.md "Mend the record; then go on." "'mend', write: fix")
expect_fault(README.md "| [a model lacks] |" "'lacks', write: is missing in")
expect_fault(CONTRIBUTING.md "A value (which stands; for now) is exact." "'stands', write: is, represents")
expect_fault(CHANGELOG.md "The lab starts a second later at the soonest." "'at the soonest', write: at least")
expect_fault(examples/README.md "`x` stood" "'stood', write: was")
expect_fault(docs/wrong.md "```\nmended\n```\nmended" "docs/wrong.md:4: 'mended'")
expect_fault(tools/cli/wrong.cpp "int f();\nconst char* kText = \"run it \\\"mended\\\"\";" "tools/cli/wrong.cpp:2: 'mended'")
expect_fault(tools/report/page/wrong.js "f(\"The data cannot tell\")" "tools/report/page/wrong.js:1: 'tell'")
expect_fault(model/wrong.hpp "int f();\n/// What a model lacks." "model/wrong.hpp:2: 'lacks', write: is missing in")
expect_fault(hal/wrong.hpp "int value = 0;  ///< what stands here" "hal/wrong.hpp:1: 'stands'")
expect_fault(tools/interface/c/wrong.h "/* A value\n * that stands here. */" "tools/interface/c/wrong.h:2: 'stands'")
expect_fault(tools/wrong "echo \"what the model lacks\"" "tools/wrong:1: 'lacks'")
expect_fault(examples/cortex-m7/wrong.hpp "/// What stands here." "examples/cortex-m7/wrong.hpp:1: 'stands'")
expect_fault(docs/wrong.md "It is exact, however much it costs." "'however much', write: at most")
expect_fault(firmware/wrong.hpp "g(\"a[1]; Whoever runs it\");" "firmware/wrong.hpp:1: 'whoever'")

expect_none(docs/right.md "Understand `mends` and StandsStill.\n```\nthe model lacks friction\n```\nbold")
expect_none(model/right.hpp "/// `stands` and \"stands\" are names.\nint stands = 0;  // it stands")
expect_none(tools/cli/right.cpp "// mended\nint house = 0;\nconst char* kText = \"amended, housed\";")
