// SPDX-License-Identifier: Apache-2.0
#include "tools/report/report_page.hpp"

#include <stdexcept>
#include <string_view>

#include "tools/files/exchange/xml_text.hpp"
#include "tools/report/page_template.hpp"
#include "tools/report/series_data.hpp"

namespace hotfire {
namespace {

/// JSON that can be inside a script element: outside of a string JSON has no `<`, and inside one the escape means the
/// same, so nothing in it can close the element or open a comment. Bytes that are not UTF-8 become U+FFFD.
std::string as_script_data(const nlohmann::json& data) {
  const std::string plain = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string escaped;
  escaped.reserve(plain.size());
  for (const char character : plain) {
    if (character == '<') {
      escaped += "\\u003c";
    } else {
      escaped += character;
    }
  }
  return escaped;
}

/// The text at the key, or empty if it is absent or no text.
std::string text_at(const nlohmann::json& report, const char* key) {
  const auto found = report.find(key);
  return found != report.end() && found->is_string() ? found->get<std::string>() : std::string();
}

void check(const nlohmann::json& report) {
  if (!report.is_object()) {
    throw std::invalid_argument("report: not a JSON object");
  }
  if (text_at(report, "verdict").empty()) {
    throw std::invalid_argument("report: 'verdict' is missing or not a text");
  }
  if (!report.contains("channels") || !report["channels"].is_object()) {
    throw std::invalid_argument("report: 'channels' is missing or not an object");
  }
}

/// Moves what comes before the place from `rest` to `page` and appends the filling.
void fill(std::string& page, std::string_view& rest, std::string_view place, std::string_view filling) {
  const std::size_t at = rest.find(place);
  if (at == std::string_view::npos) {
    throw std::logic_error("report page: a place to fill is missing in its template");
  }
  page += rest.substr(0, at);
  page += filling;
  rest.remove_prefix(at + place.size());
}

}  // namespace

std::string report_page(const nlohmann::json& report, const ReportSeries& series) {
  check(report);
  const std::string name = text_at(report, "name");
  const std::string data = as_script_data({{"report", report}, {"series", series_data(series)}});
  const std::string frame = page_template();
  std::string_view rest = frame;
  std::string page;
  page.reserve(frame.size() + data.size() + 1000);
  fill(page, rest, "@title@", escaped(name.empty() ? "Hotfire report" : name + ": Hotfire report"));
  fill(page, rest, "@headline@", escaped(text_at(report, "sentence")));
  fill(page, rest, "@data@", data);
  page += rest;
  return page;
}

}  // namespace hotfire
