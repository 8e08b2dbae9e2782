// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/result/axes_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/explain/words/conclusions.hpp"
#include "tools/files/record/axis_names.hpp"

namespace hotfire::explain {

namespace {

std::string name_of_axis(const std::string& name, const std::string& axis) { return fmt::format("{}.{}", name, axis); }

/// Texts that every axis has are given once, others with their axis.
std::vector<std::string> joined_texts(const std::vector<AxisResult>& axes, std::vector<std::string> Result::*member) {
  std::vector<std::string> texts;
  for (const AxisResult& own : axes) {
    for (const std::string& text : own.result.*member) {
      const bool is_common = std::all_of(axes.begin(), axes.end(), [&](const AxisResult& other) {
        const std::vector<std::string>& others = other.result.*member;
        return std::find(others.begin(), others.end(), text) != others.end();
      });
      const std::string named = is_common ? text : fmt::format("{}: {}", own.axis, text);
      if (std::find(texts.begin(), texts.end(), named) == texts.end()) {
        texts.push_back(named);
      }
    }
  }
  return texts;
}

void append_sentence(const std::string& axis, const std::string& sentence, std::string& text) {
  text += (text.empty() ? "" : " ") + words::of_axis(axis, sentence);
}

template <class Channel>
void append_channels(const std::vector<Channel>& own, const std::string& axis, std::vector<Channel>& all) {
  for (Channel channel : own) {
    channel.name = name_of_axis(channel.name, axis);
    all.push_back(std::move(channel));
  }
}

void append_residual(const AxisResult& own, ResidualResult& all) {
  const ResidualResult& left = own.result.residual;
  all.is_white = all.is_white && left.is_white;
  all.unexplained = std::max(all.unexplained, left.unexplained);
  if (!left.next_experiment.empty()) {
    append_sentence(own.axis, left.next_experiment, all.next_experiment);
  }
  for (ChannelResidual channel : left.channels) {
    channel.channel = name_of_axis(channel.channel, own.axis);
    all.channels.push_back(std::move(channel));
  }
}

/// More than one axis may be missing a term: then no single one explains both.
void append_located(const AxisResult& own, std::optional<LocatedResult>& all) {
  if (!own.result.located) {
    return;
  }
  LocatedResult located = *own.result.located;
  const auto name_sites = [&](std::vector<std::string>& sites) {
    for (std::string& site : sites) {
      site = name_of_axis(site, own.axis);
    }
  };
  name_sites(located.sites);
  for (LocatedPlace& place : located.places) {
    name_sites(place.sites);
    for (auto& [channel, value] : place.mean_square_over_noise) {
      channel = name_of_axis(channel, own.axis);
    }
  }
  if (!all) {
    all = std::move(located);
    return;
  }
  all->is_single = false;
  all->sites.insert(all->sites.end(), located.sites.begin(), located.sites.end());
  all->places.insert(all->places.end(), located.places.begin(), located.places.end());
  std::stable_sort(all->places.begin(), all->places.end(), [](const LocatedPlace& a, const LocatedPlace& b) {
    return a.log_likelihood_gain > b.log_likelihood_gain;
  });
}

/// The trace of the first axis with a missing effect, else of the first that has a trace.
std::optional<TraceResult> joined_trace(const std::vector<AxisResult>& axes) {
  auto chosen = std::find_if(axes.begin(), axes.end(), [](const AxisResult& own) { return !own.result.effects.empty(); });
  if (chosen == axes.end() || !chosen->result.trace) {
    chosen = std::find_if(axes.begin(), axes.end(), [](const AxisResult& own) { return own.result.trace.has_value(); });
  }
  if (chosen == axes.end()) {
    return std::nullopt;
  }
  TraceResult trace = *chosen->result.trace;
  trace.text = words::of_axis(chosen->axis, trace.text);
  return trace;
}

std::vector<RecordResult> joined_records(const std::vector<AxisResult>& axes) {
  std::vector<RecordResult> records = axes.front().result.records;
  for (std::size_t i = 0; i < records.size(); ++i) {
    records[i].channels.clear();
    for (const AxisResult& own : axes) {
      append_channels(own.result.records.at(i).channels, own.axis, records[i].channels);
    }
  }
  return records;
}

}  // namespace

Result joined_result(const std::vector<AxisResult>& axes) {
  Result joined;
  joined.model = axes.at(0).result.model;
  joined.name = axes.front().result.name;
  joined.verdict = Verdict::nothing_missing;
  joined.records = joined_records(axes);
  joined.held_out = joined_texts(axes, &Result::held_out);
  joined.warnings = joined_texts(axes, &Result::warnings);
  joined.trace = joined_trace(axes);
  for (const AxisResult& own : axes) {
    joined.verdict = std::min(joined.verdict, own.result.verdict);
    append_sentence(own.axis, own.result.sentence, joined.sentence);
    append_channels(own.result.channels, own.axis, joined.channels);
    for (CalibratedParameter parameter : own.result.calibration) {
      parameter.key = key_of_axis(parameter.key, own.axis);
      joined.calibration.push_back(std::move(parameter));
    }
    for (FoundEffect effect : own.result.effects) {
      effect.axis = own.axis;
      joined.effects.push_back(std::move(effect));
    }
    for (SearchRow row : own.result.search) {
      row.axis = own.axis;
      joined.search.push_back(std::move(row));
    }
    for (const std::string& text : own.result.identifiability) {
      joined.identifiability.push_back(words::of_axis(own.axis, text));
    }
    append_residual(own, joined.residual);
    append_located(own, joined.located);
  }
  return joined;
}

HeldOutRecord joined_record(const std::vector<AxisHeldOut>& axes) {
  HeldOutRecord joined = axes.at(0).record;
  joined.channels.clear();
  for (const AxisHeldOut& own : axes) {
    append_channels(own.record.channels, own.axis, joined.channels);
  }
  return joined;
}

void append_series(const std::string& axis, ReportSeries own, ReportSeries& all) {
  for (ReportRecord& record : own.records) {
    record.name += " (" + axis + ")";
    record.input_name += "." + axis;
    for (ReportChannel& channel : record.channels) {
      channel.name += "." + axis;
    }
    all.records.push_back(std::move(record));
  }
}

}  // namespace hotfire::explain
