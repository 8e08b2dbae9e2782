// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/sha256.hpp"

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"

namespace hotfire {

TEST_GROUP(Sha256) { test::Scratch scratch; };

// NIST, examples of SHA-256 ("abc"), and FIPS 180-2, B.3 (a million letters a), which is more than one block of the reader
// has.
TEST(Sha256, is_that_of_the_standard) {
  STRCMP_EQUAL("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad",
               sha256_of(scratch.write("abc", "abc")).c_str());
  STRCMP_EQUAL("cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0",
               sha256_of(scratch.write("a", std::string(1'000'000, 'a'))).c_str());
}

TEST(Sha256, of_a_text_is_that_of_a_file_with_the_same_bytes) {
  STRCMP_EQUAL(sha256_of(scratch.write("abc", "abc")).c_str(), sha256_of_text("abc").c_str());
}

TEST(Sha256, of_a_file_that_is_not_there_is_refused_with_its_name) {
  test::expect_message(test::refusal([&] { sha256_of(scratch.path("none")); }), {"none", "SHA-256"});
}

}  // namespace hotfire
