// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/report/report_json.hpp"

#include <algorithm>
#include <iterator>

#include "tools/explain/policy/policy.hpp"

namespace hotfire::explain {

namespace {

using nlohmann::json;

/// The schema of report.json: another number where a key changes its meaning.
constexpr int kSchema = 1;

json errors_json(const ChannelFit& fit) {
  return {{"rms", fit.rms}, {"max", fit.max}, {"bias", fit.bias}, {"fit_percent", fit.fit_percent}};
}

const char* name_of(NoiseSource source) {
  return source == NoiseSource::declared ? "declared" : source == NoiseSource::estimated ? "estimated" : "floor";
}

json interval_json(const std::optional<Interval95>& interval) {
  return interval ? json{interval->first, interval->second} : json(nullptr);
}

template <class Rows, class ToJson>
json list_of(const Rows& rows, ToJson&& to_json) {
  json list = json::array();
  std::transform(rows.begin(), rows.end(), std::back_inserter(list), to_json);
  return list;
}

json channels_json(const std::vector<ChannelErrors>& channels) {
  json all = json::object();
  for (const ChannelErrors& channel : channels) {
    json& own = all[channel.name];
    own = {{"unit", channel.unit},
           {"noise", channel.noise},
           {"before", errors_json(channel.declared)},
           {"calibrated", errors_json(channel.calibrated)},
           {"after", errors_json(channel.explained)}};
    if (channel.noise_source) {
      own["noise_source"] = name_of(*channel.noise_source);
    }
    if (channel.black_box) {
      own["black_box"] = errors_json(*channel.black_box);
    }
  }
  return all;
}

json record_json(const RecordResult& record) {
  json channels = json::object();
  for (const RecordChannel& channel : record.channels) {
    channels[channel.name] = {{"noise", channel.noise}};
    if (channel.zero) {
      channels[channel.name]["zero"] = *channel.zero;
    }
  }
  return {{"path", record.path}, {"rows", record.rows}, {"period", record.period}, {"channels", channels}};
}

json held_out_json(const HeldOutRecord& record) {
  return {
      {"path", record.path}, {"rows", record.rows}, {"period", record.period}, {"channels", channels_json(record.channels)}};
}

json calibration_json(const std::vector<CalibratedParameter>& calibration) {
  json all = json::object();
  for (const CalibratedParameter& parameter : calibration) {
    all[parameter.key] = {
        {"declared", parameter.declared},   {"value", parameter.value}, {"ci95", interval_json(parameter.interval)},
        {"tolerance", parameter.tolerance}, {"unit", parameter.unit},   {"pressed", parameter.pressed}};
  }
  return all;
}

json axes_json(const Axes& axes) {
  return {{"x_label", axes.x_label}, {"x_unit", axes.x_unit}, {"y_label", axes.y_label}, {"y_unit", axes.y_unit}};
}

json curve_json(const Curve& curve) {
  json result = axes_json(curve.axes);
  result["series"] = list_of(curve.series, [](const CurveSeries& one) {
    return json{{"name", one.name}, {"x", one.x}, {"y", one.y}};
  });
  return result;
}

json parameters_json(const std::vector<EffectParameter>& parameters) {
  json all = json::object();
  for (const EffectParameter& parameter : parameters) {
    const char* source = parameter.interval_is_of_profile ? "profile" : "curvature";
    all[parameter.name] = {{"value", parameter.value},
                           {"unit", parameter.unit},
                           {"ci95", interval_json(parameter.interval)},
                           {"identified", parameter.interval.has_value()},
                           {"interval_from", parameter.interval ? json(source) : json(nullptr)},
                           {"meaning", parameter.meaning}};
  }
  return all;
}

void put_law(const std::string& law, json& row) {
  if (!law.empty()) {
    row["law"] = law;
  }
}

void put_axis(const std::string& axis, json& row) {
  if (!axis.empty()) {
    row["axis"] = axis;
  }
}

json alternative_json(const Alternative& alternative) {
  json row{{"name", alternative.name},
           {"delta_bic", alternative.delta_criterion},
           {"held_out_error_drop_percent", alternative.held_out_drop}};
  put_law(alternative.law, row);
  return row;
}

json effect_json(const FoundEffect& effect) {
  json row{{"name", effect.name},
           {"site", effect.site},
           {"parameters", parameters_json(effect.parameters)},
           {"evidence", {{"held_out_error_drop_percent", effect.held_out_drop}, {"delta_bic", effect.delta_criterion}}},
           {"alternatives", list_of(effect.alternatives, alternative_json)}};
  put_axis(effect.axis, row);
  put_law(effect.law, row);
  if (effect.is_unlisted()) {
    row["key"] = effect.key;
    row["sites"] = effect.sites;
    row["looks_like"] = effect.looks_like;
    row["is_not"] = effect.is_not;
  }
  if (effect.curve) {
    row["curve"] = curve_json(*effect.curve);
  }
  return row;
}

json search_json(const SearchRow& row) {
  json result{{"round", row.round},     {"candidate", row.candidate}, {"delta_bic", row.delta_criterion},
              {"seconds", row.seconds}, {"decision", row.decision},   {"reason", row.reason}};
  put_axis(row.axis, result);
  put_law(row.law, result);
  if (row.held_out_ratio) {
    result["held_out_rms_ratio"] = *row.held_out_ratio;
  }
  return result;
}

json policy_json(const PolicyConstant& constant) {
  return {
      {"name", constant.name}, {"value", policy().*constant.value}, {"unit", constant.unit}, {"reason", constant.reason}};
}

json located_json(const LocatedResult& located) {
  const auto place_json = [](const LocatedPlace& place) {
    json row{{"sites", place.sites}, {"log_likelihood_gain", place.log_likelihood_gain}, {"likely", place.is_likely}};
    for (const auto& [channel, value] : place.mean_square_over_noise) {
      row["mean_square_over_noise"][channel] = value;
    }
    return row;
  };
  return {{"sites", located.sites}, {"single", located.is_single}, {"places", list_of(located.places, place_json)}};
}

json trace_json(const TraceResult& trace) {
  json points = axes_json(trace.axes);
  points["x"] = trace.x;
  points["y"] = trace.y;
  return {{"site", trace.site}, {"text", trace.text}, {"points", points}};
}

json correlation_json(const BeforeAndAfter<Correlation>& both) {
  return {{"lag_s", both.after.lags},
          {"before", both.before.values},
          {"after", both.after.values},
          {"bound99", both.after.bound99}};
}

/// One list for each member of the rows.
template <class Row>
json column(const std::vector<Row>& rows, double Row::*member) {
  return list_of(rows, [&](const Row& row) { return row.*member; });
}

json frequency_json(const BeforeAndAfter<std::vector<Band>>& both) {
  return {{"from_hz", column(both.after, &Band::from)},
          {"to_hz", column(both.after, &Band::to)},
          {"before", column(both.before, &Band::rms)},
          {"after", column(both.after, &Band::rms)},
          {"noise", column(both.after, &Band::noise)}};
}

json amplitude_json(const BeforeAndAfter<std::vector<AmplitudeRange>>& both) {
  return {{"from", column(both.after, &AmplitudeRange::from)},
          {"to", column(both.after, &AmplitudeRange::to)},
          {"before", column(both.before, &AmplitudeRange::rms)},
          {"after", column(both.after, &AmplitudeRange::rms)},
          {"seconds", column(both.after, &AmplitudeRange::seconds)}};
}

json residual_json(const ResidualResult& residual) {
  json result{{"white", residual.is_white},        {"unexplained_percent", residual.unexplained},
              {"autocorrelation", json::object()}, {"input_correlation", json::object()},
              {"by_frequency", json::object()},    {"by_amplitude", json::object()}};
  if (!residual.next_experiment.empty()) {
    result["next_experiment"] = residual.next_experiment;
  }
  for (const ChannelResidual& own : residual.channels) {
    result["autocorrelation"][own.channel] = correlation_json(own.autocorrelation);
    json& with_input = result["input_correlation"][own.channel] = correlation_json(own.input_correlation);
    with_input["independent"] = own.input_correlation.after.is_none();
    result["by_frequency"][own.channel] = frequency_json(own.by_frequency);
    result["by_amplitude"][own.channel] = amplitude_json(own.by_amplitude);
  }
  return result;
}

json baseline_json(const Baseline& baseline) {
  json channels = json::object();
  for (const BaselineChannel& channel : baseline.channels) {
    json& own = channels[channel.name] = errors_json(channel.errors);
    own["order"] = channel.order;
    own["delay"] = channel.delay;
  }
  return {{"kind", "linear"},
          {"period", baseline.period},
          {"channels", channels},
          {"better_than_explained", baseline.is_better},
          {"sentence", baseline.sentence}};
}

}  // namespace

json report_json(const Result& result) {
  json report{{"schema", kSchema},
              {"model", result.model},
              {"name", result.name},
              {"verdict", name_of(result.verdict)},
              {"sentence", result.sentence},
              {"records", list_of(result.records, record_json)},
              {"held_out", result.held_out},
              {"warnings", result.warnings},
              {"channels", channels_json(result.channels)},
              {"calibration", calibration_json(result.calibration)},
              {"effects", list_of(result.effects, effect_json)},
              {"identifiability", list_of(result.identifiability,
                                          [](const std::string& text) {
                                            return json{{"text", text}};
                                          })},
              {"residual", residual_json(result.residual)},
              {"search", list_of(result.search, search_json)}};
  report["policy"] = list_of(kPolicyConstants, policy_json);
  if (!result.held_out_records.empty()) {
    report["held_out_records"] = list_of(result.held_out_records, held_out_json);
  }
  if (result.located) {
    report["located"] = located_json(*result.located);
  }
  if (result.trace) {
    report["trace"] = trace_json(*result.trace);
  }
  if (result.baseline) {
    report["baseline"] = baseline_json(*result.baseline);
  }
  if (result.valve_bias) {
    report["valve_bias"] = *result.valve_bias;
  }
  return report;
}

}  // namespace hotfire::explain
