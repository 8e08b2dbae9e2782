// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tools/explain/data/block.hpp"
#include "tools/explain/data/exclusions.hpp"
#include "tools/explain/data/other_axis.hpp"
#include "tools/explain/data/plants.hpp"
#include "tools/explain/data/start_state.hpp"
#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"

namespace hotfire::explain {

/// One record as the finder sees it.
struct Experiment {
  std::string name;
  double start = 0.0;
  double period = 0.0;
  int log_rows = 1;  ///< rows of the log for each row here: more than one in a thinned record
  std::vector<double> input;
  std::vector<double> torque;                 ///< measured, on the engine of a hydraulic axis [N m]; empty: none
  std::vector<std::vector<double>> measured;  ///< by model channel; empty where the record does not have the channel
  std::vector<double> noise;                  ///< rms of the sensor noise by channel; 1 where the record does not have it
  std::vector<double> zero_deviation;         ///< of the prior of each channel's zero (zeros.hpp); 0: the zero is known
  std::vector<Block> fitted;                  ///< rows that a fit sees
  std::vector<Block> held_out;                ///< rows that no fit sees
  std::vector<Block> excluded;                ///< rows that the user excludes
  std::vector<std::string> unused;            ///< channels of the record that the model has no place for
  bool input_is_held = false;                 ///< the input is missing in some of those: it holds there
  StartState start_state;                     ///< of a force-driven mass
  std::size_t first_scored = 0;               ///< rows before it are simulated, not compared: the start is not at rest
  OtherAxis other;                            ///< of a hydraulic axis that is one of two
  RestOfVehicle vehicle;                      ///< of such an axis

  std::size_t rows() const { return input.size(); }
  double time_of(std::size_t row) const { return start + static_cast<double>(row) * period; }
  /// Period of the log [s].
  double log_period() const { return period / log_rows; }
  /// Rows that are compared with the model, fitted or held out, in their order.
  std::vector<Block> scored() const;
};

/// Where the noise of a channel is known from: declared, estimated from the records, or a floor below which neither applies
/// anything (`noise_floor`).
enum class NoiseSource { declared, estimated, floor };

/// All records of one run of the finder.
struct Dataset {
  std::vector<std::string> channels;  ///< of the model, in its order
  std::vector<bool> used;             ///< channels that at least one record has
  std::vector<double> noise;          ///< rms over all records by channel; 1 where unused
  std::vector<NoiseSource> noise_source;
  std::vector<Experiment> experiments;
  bool input_is_path = false;  ///< the input is a position, known at the rows: a reading needs its neighbours
  AxisGeometry geometry;       ///< read where experiments have another axis
  /// Names of the effects that the plant of the axis knows; empty: all.
  std::vector<std::string> known_effects;

  bool noise_declared(std::size_t channel) const { return noise_source[channel] == NoiseSource::declared; }
  /// True if the noise of a channel is a size of the sensor, so that an error may be said in times of it.
  bool noise_is_known(std::size_t channel) const { return noise_source[channel] != NoiseSource::floor; }
  /// True if the plant of the axis knows the effect of that name.
  bool knows(std::string_view effect) const {
    return known_effects.empty() || std::ranges::find(known_effects, effect) != known_effects.end();
  }
  /// True if the plant of the axis knows terms of unknown law.
  bool knows_unlisted() const { return known_effects.empty(); }
  /// True if the axis is one of two.
  bool has_other_axis() const { return !experiments.empty() && experiments.front().other.is_there(); }
};

/// Puts records into the model's channels, estimates the noise of each record where it is not declared, and holds blocks out
/// (`hold_out`). Over excluded rows channels are `bridged`; exclusions of other records have no meaning here.
/// Throws FileError if a record does not have the input or has none of the model's channels, UsageError if an exclusion
/// leaves nothing of a record.
Dataset make_dataset(const ModelFile& model, const std::vector<Record>& records,
                     const std::vector<Exclusion>& exclusions = {});

/// Takes the first rows of a record out of the comparison.
void forget_start(Experiment& experiment, std::size_t rows);

/// Takes the first rows of a record of a hydraulic axis out of the comparison if the residual of the calibrated model decays
/// there (`dies_out_at_start`): the axis moved before. A record with excluded rows at its start is left as it is.
/// `predicted` is by record, channel and row. Returns whether there is such a record.
bool forget_moving_starts(const ModelParameters& model, const std::vector<std::vector<std::vector<double>>>& predicted,
                          Dataset& data);

/// Position of a force-driven mass by row: as measured, else from its velocity or its acceleration by `integral_of`.
std::vector<double> position_of(const Experiment& mass);

/// A measured load, `bridged` over excluded rows. Throws UsageError for a value that is missing in a row that is not
/// excluded.
std::vector<double> load_of(const Channel& channel, const Record& record, const std::vector<Exclusion>& exclusions);

/// Gives a fit every row that is scored: nothing is held out any more.
void fit_every_row(Dataset& data);

/// The records at a period of about `period` [s]: every k-th row, under the mean of the commands held from it to the next.
/// The rows that a fit sees, are held out or excluded stay so. Records that are no faster are left as they are.
Dataset thinned(const Dataset& data, double period);
/// The records with about `rows` rows together; fewer are left as they are.
Dataset thinned_to_rows(const Dataset& data, double rows);

/// "steps.csv@8.0-12.0" for every held-out block.
std::vector<std::string> held_out_names(const Dataset& data);

}  // namespace hotfire::explain
