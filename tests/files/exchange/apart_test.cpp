// SPDX-License-Identifier: Apache-2.0
#include "tools/files/exchange/apart.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <new>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tests/support/refusal.hpp"

namespace hotfire {

namespace {

constexpr ApartLimits kLimits{1024, 1, 60, 1 << 20};

/// Why the work gave no result.
std::string failure(const std::function<std::string()>& work, const ApartLimits& limits = kLimits) {
  return test::refusal<ApartError>([&] { run_apart(work, limits); });
}

}  // namespace

TEST_GROUP(Apart){};

TEST(Apart, result_and_refusal_of_the_work_come_back_as_they_are) {
  const std::string bytes("a\0b\xFF", 4);
  CHECK(run_apart([&] { return bytes; }, kLimits) == bytes);
  CHECK(run_apart([] { return std::string(); }, kLimits).empty());
  CHECK(run_apart([] { return std::string(1 << 20, 'x'); }, kLimits).size() == 1 << 20);
  STRCMP_EQUAL("x:1: no",
               test::refusal([] { run_apart([]() -> std::string { throw FileError("x:1: no"); }, kLimits); }).c_str());
}

TEST(Apart, crash_abort_and_early_end_of_the_work_are_said_and_stay_there) {
  STRCMP_CONTAINS("crashed (signal 11", failure([]() -> std::string {
                                          std::raise(SIGSEGV);
                                          return "x";
                                        }).c_str());
  STRCMP_CONTAINS("crashed (signal 6", failure([]() -> std::string { std::abort(); }).c_str());
  STRCMP_CONTAINS("ended with status 3", failure([]() -> std::string { _exit(3); }).c_str());
}

TEST(Apart, work_without_end_and_a_result_too_large_are_ended_at_their_limits) {
  STRCMP_CONTAINS("more than 1 s", failure([]() -> std::string {
                                     for (volatile int i = 0;;) {
                                       i = i ^ 1;
                                     }
                                   }).c_str());
  const auto wait = []() -> std::string {
    for (;;) {
      pause();
    }
  };
  STRCMP_CONTAINS("has not ended after 1 s", failure(wait, {1024, 60, 1, 1}).c_str());
  STRCMP_CONTAINS("more than 1048576 bytes", failure([] { return std::string((1 << 20) + 1, 'x'); }).c_str());
#ifndef __SANITIZE_ADDRESS__
  STRCMP_CONTAINS("more than 1024 MiB", failure([]() -> std::string {
                                          if (std::malloc(std::size_t{2} << 30U) == nullptr) {
                                            throw std::bad_alloc();
                                          }
                                          return "x";
                                        }).c_str());
#endif
}

}  // namespace hotfire
