// SPDX-License-Identifier: Apache-2.0
#include "tools/explain/report/report_residual.hpp"

#include <algorithm>

#include "tools/explain/inference/residual_statistics.hpp"

namespace hotfire::explain {

using nlohmann::json;

namespace {

json correlation_json(const Correlation& before, const Correlation& after) {
  return {{"lag_s", after.lags}, {"before", before.values}, {"after", after.values}, {"bound99", after.bound99}};
}

/// One list for each member of the rows.
template <class Row>
json column(const std::vector<Row>& rows, double Row::*member) {
  json values = json::array();
  for (const Row& row : rows) {
    values.push_back(row.*member);
  }
  return values;
}

json frequency_json(const std::vector<Band>& before, const std::vector<Band>& after) {
  return {{"from_hz", column(after, &Band::from)},
          {"to_hz", column(after, &Band::to)},
          {"before", column(before, &Band::rms)},
          {"after", column(after, &Band::rms)},
          {"noise", column(after, &Band::noise)}};
}

json amplitude_json(const std::vector<AmplitudeRange>& before, const std::vector<AmplitudeRange>& after) {
  return {{"from", column(after, &AmplitudeRange::from)},
          {"to", column(after, &AmplitudeRange::to)},
          {"before", column(before, &AmplitudeRange::rms)},
          {"after", column(after, &AmplitudeRange::rms)},
          {"seconds", column(after, &AmplitudeRange::seconds)}};
}

}  // namespace

json residual_json(const Dataset& data, const Prediction& before, const Prediction& after) {
  json residual{{"autocorrelation", json::object()},
                {"input_correlation", json::object()},
                {"by_frequency", json::object()},
                {"by_amplitude", json::object()}};
  bool white = true;
  double unexplained = 0.0;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    if (!data.used[c]) {
      continue;
    }
    const std::string& channel = data.channels[c];
    const Correlation own = residual_autocorrelation(data, after, c);
    white = white && own.is_none();
    residual["autocorrelation"][channel] = correlation_json(residual_autocorrelation(data, before, c), own);
    const Correlation with_input = input_correlation(data, after, c);
    residual["input_correlation"][channel] = correlation_json(input_correlation(data, before, c), with_input);
    residual["input_correlation"][channel]["independent"] = with_input.is_none();
    residual["by_frequency"][channel] =
        frequency_json(error_by_frequency(data, before, c), error_by_frequency(data, after, c));
    residual["by_amplitude"][channel] =
        amplitude_json(error_by_amplitude(data, before, c), error_by_amplitude(data, after, c));
    const double declared = excess_over_noise(data, before, c);
    const double left = excess_over_noise(data, after, c);
    unexplained = std::max(unexplained, declared > 0.0 ? 100.0 * std::min(1.0, left / declared) : 0.0);
  }
  residual["white"] = white;
  residual["unexplained_percent"] = unexplained;
  return residual;
}

}  // namespace hotfire::explain
