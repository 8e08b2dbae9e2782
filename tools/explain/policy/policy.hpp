// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace hotfire::explain {

/// Every constant by which the finder keeps, drops, names and locates. What is not here says how finely something is
/// computed (grids, iterations), and moves no decision by more than a decision's own tolerance.
/// `hotfire-study sensitivity` varies each by 0.7 and 1.4 (docs/study.md).
struct Policy {
  /// Decrease of the BIC that supports an effect, and difference below which two candidates are tied.
  double strong_evidence = 10.0;
  /// Share of the held-out error that an effect has to remove.
  double least_held_out_drop = 0.01;
  /// Share of the held-out error above which an effect gets no name far above the noise.
  double hardly_less = 0.95;
  /// Share of an error that is clearly less than the error.
  double clearly_less = 0.7;
  /// Share of the calibrated model's error above which effects explain little.
  double little_explained = 0.5;
  /// Share of an error of which held-out data say that it is less.
  double held_out_less = 0.9;
  /// Error beyond the noise, over the noise, that settles a round.
  double nothing_left = 0.2;
  /// ... that is immaterial.
  double immaterial = 0.5;
  /// ... that is visible, and worth a term of unknown law.
  double visible = 1.0;
  /// ... that chaotic motion leaves under the true parameters, and from which on a veto counts.
  double chaotic = 1.5;
  /// ... that is still close to the noise.
  double near_noise = 3.0;
  /// Tolerances from its declared value at which a parameter compensates for a missing effect.
  double farthest_from_declared = 5.0;
  /// Share of a curve, an energy, a record's error or a gain that is the scatter of an estimate.
  double scatter = 0.05;
  /// Least gain in log likelihood of an unknown signal.
  double least_gain = 50.0;
  /// Places are tied below this difference in log likelihood,
  double tied_gain = 150.0;
  /// ... or below this share of the best gain,
  double tied_share = 0.01;
  /// ... if they leave no more than this factor of the best place's mean square. A place with the best gain that leaves more
  /// than this factor of what a place within `scatter` of its gain leaves is not the best.
  double tied_leaves = 1.25;
  /// Mean square over the noise that a single signal leaves at most.
  double left_by_single = 1.9;
  /// Share of the best gain from which places stay open if no single signal explains the records.
  double open_share = 0.1;
};

/// One constant with what a reader has to know of it.
struct PolicyConstant {
  std::string_view name;
  std::string_view unit;
  double Policy::*value;
  std::string_view reason;  ///< derivation, source or measurement
};

inline constexpr std::array kPolicyConstants{
    PolicyConstant{"strong_evidence", "BIC", &Policy::strong_evidence,
                   "odds beyond 150 to 1 (Kass and Raftery 1995, p. 777)"},
    PolicyConstant{"least_held_out_drop", "1", &Policy::least_held_out_drop,
                   "standard error of an rms over some thousand effective samples"},
    PolicyConstant{"hardly_less", "1", &Policy::hardly_less,
                   "the largest of four missing effects of equal size leaves 0.87"},
    PolicyConstant{"clearly_less", "1", &Policy::clearly_less, "half of the mean square"},
    PolicyConstant{"little_explained", "1", &Policy::little_explained, "a quarter of the mean square is unexplained"},
    PolicyConstant{"held_out_less", "1", &Policy::held_out_less,
                   "factor by which the rms of noise and a residual of 1 falls if the residual falls to clearly_less"},
    PolicyConstant{"nothing_left", "noise", &Policy::nothing_left, "the noise itself is known only to one or two percent"},
    PolicyConstant{"immaterial", "noise", &Policy::immaterial,
                   "the model is then twice as close to the truth as the sensor"},
    PolicyConstant{"visible", "noise", &Policy::visible, "as large as the noise"},
    PolicyConstant{"chaotic", "noise", &Policy::chaotic,
                   "stick-slip motions of two models of one plant separate at the first slip that only one of them has"},
    PolicyConstant{"near_noise", "noise", &Policy::near_noise,
                   "ripples of an error over rest positions are a few times the noise"},
    PolicyConstant{"farthest_from_declared", "tolerances", &Policy::farthest_from_declared,
                   "odds of one in a million if the tolerance is right, one in eighty if it is half the true one"},
    PolicyConstant{"scatter", "1", &Policy::scatter, "scatter of a curve of eleven points at the noise"},
    PolicyConstant{"least_gain", "log likelihood", &Policy::least_gain,
                   "none of 40 sets of records without a missing effect gains 10"},
    PolicyConstant{"tied_gain", "log likelihood", &Policy::tied_gain, "error of the prior and of the linear flow, absolute"},
    PolicyConstant{"tied_share", "1", &Policy::tied_share, "error of the prior and of the linear flow, relative"},
    PolicyConstant{"tied_leaves", "1", &Policy::tied_leaves, "scatter of a mean square over some hundred effective samples"},
    PolicyConstant{"left_by_single", "1", &Policy::left_by_single,
                   "chi square over N of two simultaneous effects is larger (design study, 25 cases)"},
    PolicyConstant{"open_share", "1", &Policy::open_share,
                   "the second of two effects explains a tenth of the first or more"},
};

/// The policy of this process. The same for every search but in `WithPolicy`.
const Policy& policy();

/// Another policy while it lives, for a study of its constants. No search may run while one is made or ends.
class WithPolicy {
 public:
  explicit WithPolicy(const Policy& other);
  ~WithPolicy();
  WithPolicy(const WithPolicy&) = delete;
  WithPolicy& operator=(const WithPolicy&) = delete;

 private:
  Policy before_;
};

}  // namespace hotfire::explain
