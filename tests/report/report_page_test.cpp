// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/report/samples.hpp"
#include "tools/report/report_page.hpp"
#include "tools/report/series_data.hpp"

#include <CppUTest/TestHarness.h>

using namespace hotfire;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

std::vector<float> floats_in(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t pending = 0;
  int bits = 0;
  for (const char digit : base64.substr(0, base64.find('='))) {
    pending = pending << 6 | static_cast<std::uint32_t>(digits.find(digit));
    bits += 6;
    if (bits < 8) {
      continue;
    }
    bits -= 8;
    bytes += static_cast<char>(pending >> bits & 0xFFU);
  }
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

std::string message_of(const nlohmann::json& report, const ReportSeries& series) {
  try {
    report_page(report, series);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

nlohmann::json smallest_report() { return {{"verdict", "explained"}, {"channels", {{"piston", {{"unit", "m"}}}}}}; }

ReportSeries one_record(std::vector<double> measured, std::vector<double> declared) {
  ReportRecord record{.name = "r.csv",
                      .start = 0.0,
                      .period = 0.01,
                      .held_out = {},
                      .input_name = "",
                      .input_unit = "",
                      .input = {},
                      .channels = {}};
  record.channels.push_back({"piston", "m", std::move(measured), std::move(declared), {}, {}});
  return {{record}};
}

}  // namespace

TEST_GROUP(report_page){};

TEST(report_page, names_no_address_outside_of_itself) {
  const test::Sample sample = test::explained_actuator();
  const std::string page = report_page(sample.report, sample.series);
  for (const char* address :
       {"http://", "https://", "//cdn", "<link", "<iframe", "@import", "url(", "href=", "<script src", "<img"}) {
    CHECK_FALSE_TEXT(contains(page, address), address);
  }
}

TEST(report_page, holds_the_charting_library_with_its_licence) {
  const std::string page = report_page(smallest_report(), {});
  CHECK(contains(page, "dygraphs is MIT-licenced"));
  CHECK(contains(page, "THE SOFTWARE IS PROVIDED"));
  CHECK(contains(page, "Dygraph.synchronize"));
}

TEST(report_page, says_the_sentence_and_the_name) {
  const test::Sample sample = test::explained_actuator();
  const std::string page = report_page(sample.report, sample.series);
  CHECK(contains(page, "<h1>" + sample.report["sentence"].get<std::string>() + "</h1>"));
  CHECK(contains(page, "<title>single-axis TVC actuator: Hotfire report</title>"));
}

TEST(report_page, has_a_section_for_every_view_of_the_residual) {
  const test::Sample sample = test::explained_actuator();
  const std::string page_without_data = report_page(smallest_report(), {});
  for (const auto& [key, value] : sample.report["residual"].items()) {
    CHECK_TEXT(contains(page_without_data, key), key.c_str());
  }
  for (const char* key : {"identifiability", "interval_from"}) {
    CHECK_TEXT(contains(page_without_data, key), key);
  }
}

TEST(report_page, turns_no_text_of_the_report_into_markup) {
  const test::Sample hostile = test::hostile_long_records();
  const std::string plain = report_page(smallest_report(), {});
  const std::string page = report_page(hostile.report, hostile.series);
  CHECK_EQUAL(occurrences(plain, "</script>"), occurrences(page, "</script>"));
  CHECK_EQUAL(occurrences(plain, "<script"), occurrences(page, "<script"));
  CHECK_FALSE(contains(page, "<img"));
}

TEST(report_page, fills_each_place_once_whatever_the_texts_are) {
  nlohmann::json report = smallest_report();
  report["name"] = "@data@";
  report["sentence"] = "@title@ @headline@ @data@ @library@";
  const std::string page = report_page(report, {});
  CHECK(contains(page, "<h1>@title@ @headline@ @data@ @library@</h1>"));
  CHECK(contains(page, "<script id=\"data\" type=\"application/json\">{\"report\":"));
}

TEST(report_page, replaces_bytes_that_are_no_text) {
  nlohmann::json report = smallest_report();
  report["model"] = "declared\xff.toml";
  CHECK(contains(report_page(report, {}), "declared\xEF\xBF\xBD.toml"));
}

TEST(report_page, refuses_a_report_that_it_cannot_show) {
  STRCMP_EQUAL("report: not a JSON object", message_of(nlohmann::json::array(), {}).c_str());
  STRCMP_EQUAL("report: 'verdict' is missing or not a text", message_of({{"verdict", 3}}, {}).c_str());
  STRCMP_EQUAL("report: 'channels' is missing or not an object", message_of({{"verdict", "explained"}}, {}).c_str());
}

TEST(report_page, refuses_series_of_different_lengths) {
  STRCMP_EQUAL(
      "report of record 'r.csv': channel 'piston', declared model, has 1 rows, channel 'piston' has 2; all must have the "
      "same",
      message_of(smallest_report(), one_record({1.0, 2.0}, {1.0})).c_str());
}

TEST(report_page, refuses_a_record_without_a_period) {
  ReportSeries series = one_record({1.0}, {});
  series.records.front().period = 0.0;
  STRCMP_EQUAL("report of record 'r.csv': period 0 s, it must be positive", message_of(smallest_report(), series).c_str());
}

TEST_GROUP(series_data){};

TEST(series_data, is_base64_of_little_endian_floats) {
  const nlohmann::json data = series_data(one_record({1.0, -2.5}, {1.0, -2.0}));
  const nlohmann::json& channel = data["records"][0]["channels"][0];
  STRCMP_EQUAL("AACAPwAAIMA=", channel["measured"].get<std::string>().c_str());
  STRCMP_EQUAL("AAAAAAAAAL8=", channel["errors"]["declared"].get<std::string>().c_str());
}

TEST(series_data, keeps_the_digits_of_a_residual_beside_a_large_measurement) {
  const double step = 1.0 / 1024.0;
  const nlohmann::json data = series_data(one_record({2e7 + step}, {2e7}));
  STRCMP_EQUAL("AACAOg==", data["records"][0]["channels"][0]["errors"]["declared"].get<std::string>().c_str());
}

TEST(series_data, holds_every_row_up_to_the_limit) {
  const std::vector<double> values(kFullResolutionRows, 1.0);
  const nlohmann::json data = series_data(one_record(values, values));
  CHECK_EQUAL(kFullResolutionRows, data["kept"].get<std::size_t>());
  CHECK_FALSE(data["records"][0].contains("kept"));
}

TEST(series_data, keeps_every_peak_above_the_limit) {
  std::vector<double> measured(kFullResolutionRows * 3, 0.0);
  const std::vector<double> declared(measured.size(), 0.0);
  const std::size_t peaks[] = {0, 123'457, measured.size() - 1};
  for (const std::size_t peak : peaks) {
    measured[peak] = 1.0;
  }
  measured[300'000] = std::numeric_limits<double>::quiet_NaN();
  const nlohmann::json data = series_data(one_record(measured, declared));
  const auto kept = data["kept"].get<std::size_t>();
  CHECK(kept > 1000 && kept <= kFullResolutionRows);
  const std::vector<float> shown = floats_in(data["records"][0]["channels"][0]["measured"]);
  CHECK_EQUAL(kept, shown.size());
  CHECK_EQUAL(static_cast<std::ptrdiff_t>(std::size(peaks)), std::count(shown.begin(), shown.end(), 1.0F));
}
