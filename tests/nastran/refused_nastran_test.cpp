// SPDX-License-Identifier: Apache-2.0
#include <sstream>
#include <vector>

#include "tests/files/expect.hpp"
#include "tests/nastran/four_modes.hpp"
#include "tests/nastran/write_op2.hpp"
#include "tools/nastran/geometry.hpp"
#include "tools/nastran/projection.hpp"

namespace hotfire::nastran {

TEST_GROUP(RefusedNastran) {
  test::Scratch scratch;

  static std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
      lines.push_back(line);
    }
    return lines;
  }
  static std::string joined(const std::vector<std::string>& lines, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < std::min(count, lines.size()); ++i) {
      text += lines[i] + "\n";
    }
    return text;
  }
  std::string refusal_of(const std::string& ending, const std::string& text) const {
    scratch.write("four_modes.bdf", test::content_of(test::four_modes("bdf")));
    scratch.write("modes." + ending, text);
    const auto map =
        test::write_map(scratch, "modes." + ending, "four_modes.bdf", ending == "pch" ? "generalised_mass = 1.0\n" : "");
    return test::refusal([&] { project(map); });
  }
  std::string map_refusal(const std::string& from, const std::string& to) const {
    scratch.write("four_modes.f06", test::content_of(test::four_modes("f06")));
    const std::string map = test::content_of(test::write_map(scratch, "four_modes.f06", "four_modes.f06"));
    const auto path = scratch.write("wrong.toml", test::replaced(map, from, to));
    return test::refusal([&] { project(path); });
  }

  /// In every line of a wanted grid, spoils one of its numbers, and expects the number of this line in the refusal.
  void expect_every_damage_named(const std::string& ending, const std::string& mark) const {
    const std::vector<std::string> lines = lines_of(test::content_of(test::four_modes(ending)));
    int spoilt = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto at = lines[i].find(mark);
      const bool is_wanted = lines[i].find("  202  ") != std::string::npos && lines[i].find(" G ") != std::string::npos;
      if (!is_wanted || at == std::string::npos) {
        continue;
      }
      std::vector<std::string> damaged = lines;
      damaged[i].replace(at, 4, "****");
      test::expect_message(refusal_of(ending, joined(damaged, damaged.size())),
                           {("modes." + ending + ":" + std::to_string(i + 1) + ":").c_str(), "grid 202", "****"});
      ++spoilt;
    }
    LONGS_EQUAL(5, spoilt);
  }
};

TEST(RefusedNastran, ADamagedNumberIsNamedWithItsLine) {
  expect_every_damage_named("f06", "0.0 ");
  expect_every_damage_named("pch", "0000");
}

// A punch file has no table of its modes: one that ends between two modes has those before.
TEST(RefusedNastran, ACutTextFileIsRefusedWhereverItEnds) {
  for (const std::string ending : {"f06", "pch"}) {
    const std::vector<std::string> lines = lines_of(test::content_of(test::four_modes(ending)));
    bool is_between_modes = false;
    std::size_t count = 1;
    for (int vectors = 0; vectors < 5; ++count) {
      const std::string& last = lines[count - 1];
      const bool ends_a_mode = ending == "f06" ? last.find("           303      G") == 0
                                               : count > 1 && lines[count - 2].find("       303       G") == 0;
      vectors += ends_a_mode ? 1 : 0;
      is_between_modes = ends_a_mode || (is_between_modes && last.find("$EIGENVALUE") != 0);
      if (vectors < 5 && (ending == "f06" || !is_between_modes || vectors < 2)) {
        const std::string refusal = refusal_of(ending, joined(lines, count));
        STRCMP_CONTAINS("modes.", refusal.c_str());
      }
    }
    STRCMP_EQUAL("", refusal_of(ending, joined(lines, count - 1)).c_str());
  }
}

TEST(RefusedNastran, ACutOrTurnedBinaryFileIsRefusedWithItsByte) {
  const std::string whole = test::four_modes_op2({});
  int refused = 0;
  for (std::size_t size = 0; size + 1 < whole.size(); size += 37) {
    const std::string refusal = refusal_of("op2", whole.substr(0, size));
    CHECK_FALSE(refusal.empty());
    STRCMP_CONTAINS("modes.op2", refusal.c_str());
    ++refused;
  }
  CHECK_TRUE(refused > 50);
  // The length of a record of the table OUGV1.
  std::string damaged = whole;
  damaged[damaged.size() - 28] = static_cast<char>(damaged[damaged.size() - 28] ^ 0x40);
  test::expect_message(refusal_of("op2", damaged), {"modes.op2: byte", "damaged"});
}

TEST(RefusedNastran, ARunThatNastranEndedIsNotRead) {
  const std::string text = test::content_of(test::four_modes("f06"));
  test::expect_message(refusal_of("f06", text + " *** USER FATAL MESSAGE 9137 (SEKRRS)\n"),
                       {"modes.f06:157:", "USER FATAL MESSAGE 9137", "correct its run"});
}

TEST(RefusedNastran, ValuesAndVectorsOfDifferentRunsDoNotMix) {
  const std::string text = test::content_of(test::four_modes("f06"));
  test::expect_message(
      refusal_of("f06", test::replaced(text, "1.579137E+02        1.256637E+01", "1.600000E+02        1.264911E+01")),
      {"modes.f06:28:", "mode 2", "one run"});
  test::expect_message(refusal_of("f06", text + text), {"modes.f06:", "given twice"});
  const std::string punch = test::content_of(test::four_modes("pch"));
  test::expect_message(refusal_of("pch", punch + punch), {"modes.pch:", "given twice"});
}

TEST(RefusedNastran, FilesWithoutWhatIsWantedAreRefused) {
  test::expect_message(refusal_of("f06", "nothing\n"), {"modes.f06:1:", "no eigenvector"});
  test::expect_message(refusal_of("f06", std::string("a\0b", 3)), {"modes.f06:1:", "not text"});
  test::expect_message(refusal_of("xyz", "nothing\n"), {"modes.xyz", ".f06, .pch, .op2"});
  test::expect_message(refusal_of("op2", "nothing at all"), {"modes.op2: byte 0", "PARAM,POST,-1"});
  const std::string punch =
      test::replaced(test::content_of(test::four_modes("pch")), "$REAL OUTPUT", "$REAL-IMAGINARY OUTPUT");
  test::expect_message(refusal_of("pch", punch), {"modes.pch:5:", "complex"});
}

TEST(RefusedNastran, AMapIsRefusedWithItsLineAndARemedy) {
  test::expect_message(map_refusal("damping = 0.01\n", ""), {"wrong.toml:1", "damping: missing"});
  test::expect_message(map_refusal("damping = 0.01", "damping = 1.5"), {"wrong.toml:6:", "from 0 to below 1"});
  test::expect_message(map_refusal("damping = 0.01", "damping = [0.01, 0.02]"), {"wrong.toml:6:", "2 ratios for 4 modes"});
  test::expect_message(map_refusal("engine = 202", "engine = 999"), {"wrong.toml:8:", "grid point 999", "GRID"});
  test::expect_message(map_refusal("engine = 202", "engine = 201"), {"wrong.toml:9:", "same place"});
  test::expect_message(map_refusal("engine = 202", "engine = -2"), {"wrong.toml:8:", "above 0"});
  test::expect_message(map_refusal("engine = 202", "engin = 202"), {"wrong.toml:8:", "did you mean \"engine\"?"});
  test::expect_message(map_refusal("[attach.yaw1]", "[attach.yaw2]"), {"attach.yaw1: missing"});
  test::expect_message(map_refusal("[gimbal.engine1]", "[gimbal.engine2]"), {"engine2", "engine1"});
  test::expect_message(map_refusal("length = \"in\"", "length = \"s\""),
                       {"wrong.toml:4:", "allowed: a unit such as \"in\""});
  test::expect_message(map_refusal("damping", "least_frequency = \"50 Hz\"\ndamping"), {"no mode above 50 Hz"});
  test::expect_message(map_refusal("at = [30, 40, 0]", "at = [30, 40]"), {"wrong.toml:12:", "[x, y, z]"});
}

TEST(RefusedNastran, APunchFileWithoutAMassIsAskedFor) {
  scratch.write("four_modes.bdf", test::content_of(test::four_modes("bdf")));
  scratch.write("modes.pch", test::content_of(test::four_modes("pch")));
  const auto map = test::write_map(scratch, "modes.pch", "four_modes.bdf");
  test::expect_message(test::refusal([&] { project(map); }),
                       {"map.toml:1", "generalised_mass: missing", "normalised to mass"});
}

TEST(RefusedNastran, BulkDataIsRefusedWithItsLine) {
  const auto refusal = [&](const std::string& text) {
    const auto path = scratch.write("model.bdf", text);
    return test::refusal([&] { load_geometry(path); });
  };
  test::expect_message(refusal("$ nothing\n"), {"model.bdf:1:", "no GRID entry"});
  test::expect_message(refusal("GRID,1,,0.,0.,0.\nGRID,1,,0.,0.,0.\n"), {"model.bdf:2:", "twice"});
  test::expect_message(refusal("GRID,1,,0.,x,0.\n"), {"model.bdf:1:", "\"x\"", "field 5"});
  test::expect_message(refusal("GRID,1,4,0.,0.,0.\n"), {"model.bdf:1:", "system 4 is not defined"});
  test::expect_message(refusal("CORD2C,4,,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,4,0.,0.,0.\n"),
                       {"model.bdf:1:", "CORD2C", "CORD2R"});
  test::expect_message(refusal("CORD2R,4,4,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,1,4,0.,0.,0.\n"), {"model.bdf:1:", "itself"});
  test::expect_message(refusal("CORD2R,4,,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\nGRID,1,4,0.,0.,0.\n"),
                       {"model.bdf:1:", "on a line"});
}

}  // namespace hotfire::nastran
