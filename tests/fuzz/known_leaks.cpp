// SPDX-License-Identifier: Apache-2.0
// The lexer of UDUNITS-2 loses the words of a unit that it refuses: a few bytes for each refused file. The limit on memory
// still holds for all that a fuzzer's run takes.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:utlex\n"; }
