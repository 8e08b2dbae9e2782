# SPDX-License-Identifier: Apache-2.0
# Shows clang-format and clang-tidy sources with one defect each, and expects each to be named: a check that a typing error
# in its configuration switched off is noticed here.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${SCRATCH})

function(lint code output)
  file(WRITE ${SCRATCH}/source.cpp "${code}\n")
  execute_process(COMMAND ${CLANG_TIDY} --quiet --config-file=${ROOT}/tools/style/clang-tidy ${SCRATCH}/source.cpp -- -std=c++20
    RESULT_VARIABLE result OUTPUT_VARIABLE text ERROR_QUIET)
  set(${output} "${result} ${text}" PARENT_SCOPE)
endfunction()

function(expect_finding check code)
  lint("${code}" text)
  if(text MATCHES "^0 " OR NOT text MATCHES "${check}")
    message(SEND_ERROR "${check} does not see: ${code}\n${text}")
  endif()
endfunction()

lint("namespace hotfire {\nconstexpr int kLimit = 3;\nint twice(int value) { return kLimit * value; }\n}  // namespace hotfire" text)
if(NOT text MATCHES "^0 ")
  message(SEND_ERROR "a source without a defect: ${text}")
endif()

expect_finding(readability-identifier-naming "int BadName(int value) { return value; }")
expect_finding(readability-identifier-naming "class Some {\n public:\n  int get() const { return value; }\n\n private:\n  int value = 0;\n};")
expect_finding(readability-identifier-naming "constexpr int LIMIT = 3;")
expect_finding(bugprone-use-after-move
  "#include <string>\n#include <utility>\nvoid take(std::string s);\nauto f(std::string s) {\n  take(std::move(s));\n  return s.size();\n}")
expect_finding(bugprone-integer-division "double f(int a, int b) { return a / b; }")
expect_finding(bugprone-narrowing-conversions "int f(long a) {\n  int b = 0;\n  b = a;\n  return b;\n}")
expect_finding(bugprone-branch-clone "int f(bool a) {\n  if (a) {\n    return 1;\n  } else {\n    return 1;\n  }\n}")
expect_finding(cppcoreguidelines-pro-type-member-init "struct Point {\n  int x;\n  int y;\n};\nint f() {\n  Point p;\n  return p.x;\n}")
expect_finding(modernize-use-override "struct A {\n  virtual ~A() = default;\n  virtual void f();\n};\nstruct B : A {\n  virtual void f();\n};")
expect_finding(performance-unnecessary-value-param
  "#include <string>\nstd::size_t f(const std::string s) { return s.size(); }")
expect_finding(readability-braces-around-statements "int f(bool a) {\n  if (a) return 1;\n  return 2;\n}")
expect_finding(clang-diagnostic-error "int f() { return undeclared; }")

file(WRITE ${SCRATCH}/source.cpp "int  f( ){return 1;}\n")
execute_process(COMMAND ${CLANG_FORMAT} --style=file:${ROOT}/.clang-format --dry-run --Werror ${SCRATCH}/source.cpp
  RESULT_VARIABLE result ERROR_QUIET)
if(result EQUAL 0)
  message(SEND_ERROR "clang-format does not see an unformatted line")
endif()
