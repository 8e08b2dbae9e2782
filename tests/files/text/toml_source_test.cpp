// SPDX-License-Identifier: Apache-2.0
#include "tools/files/text/toml_source.hpp"

#include <string>

#include "tests/files/expect.hpp"
#include "tests/files/scratch.hpp"
#include "tools/files/text/toml_keys.hpp"

namespace hotfire {

using test::expect_message;
using test::refusal;

namespace {

/// A key of so many parts.
std::string key_of(std::size_t parts, const std::string& between = ".") {
  std::string key = "a";
  for (std::size_t i = 1; i < parts; ++i) {
    key += between + "a";
  }
  return key;
}

}  // namespace

TEST_GROUP(TomlSource) {
  test::Scratch scratch;

  std::string refused(const std::string& text) const {
    return refusal([&] { TomlSource(scratch.write("m.toml", text)); });
  }
};

TEST(TomlSource, key_of_100000_parts_is_refused_with_its_line_and_the_limit_wherever_it_stands) {
  const std::string deep = key_of(100'000);
  expect_message(refused("schema = 1\n" + deep + " = 1\n"), {"m.toml:2: a key of more than 16 parts; allowed: up to 16"});
  expect_message(refused("schema = 1\n\n[" + deep + "]\n"), {"m.toml:3: a key of more than 16 parts"});
  expect_message(refused("[[" + deep + "]]\n"), {"m.toml:1: a key of more than 16 parts"});
  expect_message(refused("x = {" + deep + " = 1}\n"), {"m.toml:1: a key of more than 16 parts"});
  expect_message(refused(key_of(100'000, " . ") + " = 1\n"), {"m.toml:1: a key of more than 16 parts"});
  expect_message(refused(key_of(50'000, ".\"=[,\".'#'.") + " = 1\n"), {"m.toml:1: a key of more than 16 parts"});
}

TEST(TomlSource, strings_of_every_kind_end_where_toml_ends_them) {
  const std::string deep = key_of(100'000) + " = 1\n";
  for (const char* before : {"x = \"a\\\"\"\n", "x = 'a\\'\n", "x = \"\"\"a\n\"b\"\"\"\"\"\n", "x = '''a''''\n",
                             "x = \"\"\n", "x = \"\"\"\"\"\"\n", "x = ''''''\n", "x = 1 # \"\n", "x = \"\"\"\\\"\"\"\"\n"}) {
    CHECK_TRUE_TEXT(refused(std::string(before)).empty(), before);
    STRCMP_CONTAINS("a key of more than 16 parts", refused(before + deep).c_str());
  }
}

TEST(TomlSource, keys_up_to_the_limit_and_points_in_numbers_strings_and_comments_are_read) {
  const std::string points = key_of(1000);
  STRCMP_EQUAL("", refused(key_of(kMostKeyParts) + " = 1\n").c_str());
  STRCMP_EQUAL(
      "", refused("x = [1.0, 2.0, 3.5,\n 4.5]\ny = \"" + points + "\"\nz = '''\n" + points + "'''\n# " + points).c_str());
}

TEST(TomlSource, letter_beyond_ascii_is_refused_but_in_strings_and_comments) {
  // The parser's table of letters has no entry for the first of these.
  expect_message(refused("schema = 1\n5soverruns\u0389ema = 1\n"), {"m.toml:2: a letter beyond ASCII"});
  expect_message(refused("[\u00e4]\n"), {"m.toml:1: a letter beyond ASCII"});
  expect_message(refused("x = 1 \u00b5\n"), {"m.toml:1: a letter beyond ASCII"});
  STRCMP_EQUAL("", refused("x = \"\u0389\" # \u0389\ny = '''\n\u00e4'''\n\"\u00e4\" = 1\n").c_str());
  STRCMP_EQUAL("", refused("\xef\xbb\xbfx = 1\n").c_str());
}

TEST(TomlSource, quote_inside_of_a_word_begins_no_string_and_is_refused) {
  // The parser reads on behind the quote and meets a letter that its table does not have.
  expect_message(refused("schema = 1\ntopology = 11'1\u033e1'\n"),
                 {"m.toml:2: a quote, a bracket or = inside a key or a number"});
  expect_message(refused("x = 1\"\u033e\"\n"), {"m.toml:1: a quote, a bracket or = inside"});
  expect_message(refused("a'b' = 1\n"), {"m.toml:1: a quote, a bracket or = inside"});
  STRCMP_EQUAL("", refused("x=['a',\"b\"]\ny={'k'='v'}\na.'b'='c'#'\n").c_str());
}

TEST(TomlSource, quote_bracket_or_equals_sign_inside_of_a_value_is_refused_in_tables_and_arrays_too) {
  // The parser reads a value up to a space, a comma or a closing bracket, and its table does not have this letter.
  for (const char* text :
       {"x = 10:04:8:['\ufeef#", "x = 1=\"\ufeef\"", "x = 1.\"\ufeef\"", "x = =\"\ufeef\"", "x = .'\ufeef'",
        "x = [1, 2['\ufeef']]", "x = {a = 1{\"\ufeef\"}}", "x = {a = [1], b = 2'\ufeef'}"}) {
    expect_message(refused(text), {"m.toml:1: a quote, a bracket or = inside"});
  }
  expect_message(refused("x = [1,\n2='\ufeef']"), {"m.toml:2: a quote, a bracket or = inside"});
  STRCMP_EQUAL("", refused("x = [[1,2],['\ufeef']]\ny={a=[1,{b='c', e=0.5e1}],d=-2}\n[t]\nz=1\n[[u]]\nv.'\ufeef'='\ufeef'\n"
                           "[t.\"w\"]\nd = 2026-11-24 10:00:00\nl = [\n1, # '\n]\n'k' = inf\n")
                       .c_str());
}

TEST(TomlSource, letter_beyond_ascii_behind_a_backslash_is_refused) {
  expect_message(refused("x = 1\ny = \"\"\"a\\\ufbff\"\"\"\n"), {"m.toml:2: a letter beyond ASCII behind a backslash"});
  expect_message(refused("y = \"\"\"a\\  \n  \u00e4\"\"\"\n"), {"m.toml:2: a letter beyond ASCII behind a backslash"});
  expect_message(refused("y = \"a\\\u00e4\"\n"), {"m.toml:1: a letter beyond ASCII behind a backslash"});
  STRCMP_EQUAL("", refused("x = \"\"\"\\\\\u00e4\\\n  a\u00e4\"\"\"\ny = '\\\u00e4'\n").c_str());
}

TEST(TomlSource, file_of_over_a_megabyte_and_one_without_end_are_refused) {
  expect_message(refused(std::string((1U << 20U) + 1, '\n')), {"m.toml:1: over 1048576 bytes"});
  expect_message(refusal([] { TomlSource("/dev/zero"); }), {"/dev/zero:1: over 1048576 bytes"});
}

// What may stand within each other is bounded by the parser; the stack takes all of it at once.
TEST(TomlSource, deepest_nesting_that_is_read_leaves_the_stack_whole) {
  std::string text = key_of(kMostKeyParts) + " = ";
  std::string after;
  for (int i = 0; i < 250; ++i) {
    text.append("{").append(key_of(kMostKeyParts)).append(" = ");
    after += "}";
  }
  STRCMP_EQUAL("", refused(text + "1" + after + "\n").c_str());
}

}  // namespace hotfire
