// SPDX-License-Identifier: Apache-2.0
#include "tools/study/tally/cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>

#include "tools/explain/explain.hpp"
#include "tools/explain/refine/watch.hpp"
#include "tools/study/tally/judge.hpp"

namespace hotfire::study {
namespace {

/// Of the records' own length; two: each is given twice.
constexpr std::array kShares{0.25, 0.5, 0.75, 1.0, 2.0};

std::vector<Record> share_of(const std::vector<Record>& records, double share) {
  std::vector<Record> part = records;
  for (Record& record : part) {
    record.rows = static_cast<std::size_t>(static_cast<double>(record.rows) * std::min(share, 1.0));
    for (Channel& channel : record.channels) {
      channel.values.resize(record.rows);
    }
  }
  if (share > 1.0) {
    for (Record again : records) {
      again.name = "again-" + again.name;
      part.push_back(std::move(again));
    }
  }
  return part;
}

std::string names_of(const std::vector<explain::FoundEffect>& effects) {
  std::vector<std::string> names;
  std::transform(effects.begin(), effects.end(), std::back_inserter(names), std::mem_fn(&explain::FoundEffect::name));
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, " + "));
}

}  // namespace

CostLine line_through(const std::vector<CostPoint>& points) {
  const auto count = static_cast<double>(points.size());
  double length = 0.0;
  double seconds = 0.0;
  for (const CostPoint& point : points) {
    length += point.length / count;
    seconds += point.processor_seconds / count;
  }
  double length_square = 0.0;
  double seconds_square = 0.0;
  double product = 0.0;
  for (const CostPoint& point : points) {
    length_square += (point.length - length) * (point.length - length);
    seconds_square += (point.processor_seconds - seconds) * (point.processor_seconds - seconds);
    product += (point.length - length) * (point.processor_seconds - seconds);
  }
  const double slope = product / length_square;
  return {seconds - slope * length, slope, product * product / (length_square * seconds_square)};
}

std::vector<CostPoint> cost_by_length(const std::filesystem::path& folder, unsigned threads) {
  const ModelFile model = load_model(folder / "given/declared.toml");
  const std::vector<Record> records = given_records(folder / "given");
  std::vector<CostPoint> points;
  for (const double share : kShares) {
    const std::vector<Record> part = share_of(records, share);
    CostPoint point;
    for (const Record& record : part) {
      point.length += static_cast<double>(record.rows) * record.period;
    }
    explain::ExplainOptions options;
    options.threads = threads;
    const explain::Stopwatch stopwatch;
    const auto explanation = explain::explain(model, part, options);
    point.processor_seconds = stopwatch.processor_seconds();
    point.found = names_of(explanation.result.effects);
    points.push_back(point);
  }
  return points;
}

std::string table_of(const std::vector<CostPoint>& points) {
  const CostLine line = line_through(points);
  std::string text = "  record [s]  processor [s]  on the line  found\n";
  for (const CostPoint& point : points) {
    text += fmt::format("{:12.1f} {:14.1f} {:12.1f}  {}\n", point.length, point.processor_seconds,
                        line.fixed + line.slope * point.length, point.found);
  }
  return text + fmt::format("processor = {:.2f} s + {:.4f} per second of record; r^2 = {:.3f}\n", line.fixed, line.slope,
                            line.correlation);
}

nlohmann::json json_of(const std::vector<CostPoint>& points) {
  const CostLine line = line_through(points);
  nlohmann::json result{{"fixed", line.fixed}, {"slope", line.slope}, {"r2", line.correlation}};
  for (const CostPoint& point : points) {
    result["points"].push_back(
        {{"length", point.length}, {"processor_seconds", point.processor_seconds}, {"found", point.found}});
  }
  return result;
}

}  // namespace hotfire::study
