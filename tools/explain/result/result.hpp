// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/explain/fit/goodness.hpp"
#include "tools/explain/inference/residual_statistics.hpp"

namespace hotfire::explain {

// The result of `explain`. report.json has the same content (docs/report.md says what each figure means); numbers are in the
// unit beside them.

/// From the worst to the best.
enum class Verdict { undecided, unlisted_effect, partly_explained, explained, nothing_missing };

/// "partly-explained", as report.json has it.
std::string_view name_of(Verdict verdict);

/// Lower and upper end of a 95 % interval.
using Interval95 = std::pair<double, double>;

/// Errors of the three models on one channel, of rows that no fit has seen.
struct ChannelErrors {
  std::string name;
  std::string unit;
  double noise = 0.0;                       ///< rms
  std::optional<NoiseSource> noise_source;  ///< none for a whole held-out record
  ChannelFit declared;
  ChannelFit calibrated;
  ChannelFit explained;
  std::optional<ChannelFit> black_box;  ///< of the linear black box, on a whole held-out record
};

struct RecordChannel {
  std::string name;
  double noise = 0.0;          ///< rms in this record
  std::optional<double> zero;  ///< measured minus modelled; none where the zero is known
};

struct RecordResult {
  std::string path;
  std::size_t rows = 0;
  double period = 0.0;  ///< [s]
  std::vector<RecordChannel> channels;
};

struct HeldOutRecord {
  std::string path;
  std::size_t rows = 0;
  double period = 0.0;  ///< [s]
  std::vector<ChannelErrors> channels;
};

/// A declared parameter within its tolerance.
struct CalibratedParameter {
  std::string key;
  std::string unit;
  double declared = 0.0;
  double value = 0.0;
  std::optional<Interval95> interval;
  double tolerance = 0.0;  ///< relative, one standard deviation
  bool pressed = false;    ///< at the limit of its tolerance
};

/// A parameter of an effect that was found.
struct EffectParameter {
  std::string name;
  std::string unit;
  std::string meaning;
  double value = 0.0;
  std::optional<Interval95> interval;  ///< none where the data do not identify the parameter
  bool interval_is_of_profile = false;
};

struct CurveSeries {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
};

struct Axes {
  std::string x_label;
  std::string x_unit;
  std::string y_label;
  std::string y_unit;
};

struct Curve {
  Axes axes;
  std::vector<CurveSeries> series;
};

/// Another effect that the records support in the place of the one that was found.
struct Alternative {
  std::string name;
  std::string law;
  double delta_criterion = 0.0;  ///< BIC relative to the effect that was found
  double held_out_drop = 0.0;    ///< of the error [%]
};

struct FoundEffect {
  std::string name;  ///< "unlisted" for a term of unknown law
  std::string key;   ///< its name in explained.toml
  std::string axis;  ///< "pitch" of two axes, else ""
  std::string site;
  std::vector<std::string> sites;  ///< of a term of unknown law: those that the records do not separate
  std::string law;                 ///< "" for an effect without laws
  std::vector<EffectParameter> parameters;
  double held_out_drop = 0.0;    ///< of the error [%]
  double delta_criterion = 0.0;  ///< BIC with it less BIC without it
  std::vector<Alternative> alternatives;
  std::string looks_like;  ///< of a term of unknown law
  std::string is_not;      ///< of a term of unknown law
  std::optional<Curve> curve;

  bool is_unlisted() const { return !sites.empty(); }
};

/// What the equations leave over when measured motion is put in.
struct TraceResult {
  std::string site;
  std::string text;
  Axes axes;
  std::vector<double> x;
  std::vector<double> y;
};

/// A place where the missing term may act.
struct LocatedPlace {
  std::vector<std::string> sites;
  double log_likelihood_gain = 0.0;
  bool is_likely = false;
  std::vector<std::pair<std::string, double>> mean_square_over_noise;  ///< by channel
};

struct LocatedResult {
  std::vector<std::string> sites;
  bool is_single = false;
  std::vector<LocatedPlace> places;  ///< the best first
};

/// A statistic of the residual of the declared and of the explained model.
template <class Statistic>
struct BeforeAndAfter {
  Statistic before;
  Statistic after;
};

struct ChannelResidual {
  std::string channel;
  BeforeAndAfter<Correlation> autocorrelation;
  BeforeAndAfter<Correlation> input_correlation;
  BeforeAndAfter<std::vector<Band>> by_frequency;
  BeforeAndAfter<std::vector<AmplitudeRange>> by_amplitude;
};

struct ResidualResult {
  bool is_white = true;
  double unexplained = 0.0;     ///< of the declared model's error [%]
  std::string next_experiment;  ///< "" if none is proposed
  std::vector<ChannelResidual> channels;
};

/// One candidate in one round.
struct SearchRow {
  std::string axis;  ///< "pitch" of two axes, else ""
  int round = 0;
  std::string candidate;
  std::string law;
  double delta_criterion = 0.0;
  std::optional<double> held_out_ratio;  ///< none if it was not fitted jointly
  double seconds = 0.0;
  std::string decision;
  std::string reason;
};

struct BaselineChannel {
  std::string name;
  ChannelFit errors;
  std::size_t order = 0;
  double delay = 0.0;  ///< [s]
};

/// The best linear black box on the same held-out rows.
struct Baseline {
  double period = 0.0;  ///< [s]
  std::vector<BaselineChannel> channels;
  bool is_better = false;
  std::string sentence;
};

struct Result {
  std::string model;  ///< path of the declared model
  std::string name;
  Verdict verdict = Verdict::undecided;
  std::string sentence;
  std::vector<RecordResult> records;
  std::vector<std::string> held_out;  ///< "steps.csv@8.0-12.0"
  std::vector<HeldOutRecord> held_out_records;
  std::vector<std::string> warnings;
  std::vector<ChannelErrors> channels;
  std::vector<CalibratedParameter> calibration;
  std::vector<FoundEffect> effects;  ///< in the order in which they were found
  std::vector<std::string> identifiability;
  ResidualResult residual;
  std::vector<SearchRow> search;
  std::optional<LocatedResult> located;
  std::optional<TraceResult> trace;
  std::optional<Baseline> baseline;
  std::optional<double> valve_bias;  ///< of the servovalve's command; the zeros of all records follow from it
};

}  // namespace hotfire::explain
