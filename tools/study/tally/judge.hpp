// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/model/model_file.hpp"
#include "tools/files/record/record.hpp"
#include "tools/study/cases/similar.hpp"

namespace hotfire::study {

/// What the finder made of one case.
struct Judgement {
  std::string name;
  std::vector<std::string> wanted;       ///< names, or "unlisted@SITE|SITE"; of two axes "cross_axis.pitch"
  std::string wanted_law;                ///< the law of what is missing, if it has laws, in words if it was drawn
  bool is_wild = false;                  ///< whether something of it was drawn at random
  std::vector<std::string> found;        ///< names, those without a name as "unlisted@SITE"
  std::vector<std::string> found_laws;   ///< in the order of `found`; "" for an effect without laws
  std::vector<std::string> found_sites;  ///< several with bars between them, where the finder says that it is one of these
  std::string verdict;
  std::map<std::string, double> before;  ///< declared model on the unseen record, rms in sensor noise, by channel
  std::map<std::string, double> effect;  ///< what the effects alone make
  std::map<std::string, double> after;   ///< explained model
  std::map<std::string, double> truth;  ///< the model with the true parameters, if it has keys for them: what can be reached
  double seconds = 0.0;                 ///< that the finder took
  double processor_seconds = 0.0;       ///< the same of all threads' processor time
  /// All that is missing and listed is named and nothing else; beside what is unlisted: is named; null: nothing said to be
  /// missing.
  bool names_right = false;
  bool below_noise = false;  ///< `after` below 1 in every channel
  // Unlisted only.
  bool wrong_name = false;   ///< a listed effect was named that is no part of the truth
  bool site_right = false;   ///< something unlisted was found, and all of that where the unlisted effect acts
  bool halved = false;       ///< in the channel where the effect shows most, `after` is below half of `effect`
  std::string failure;       ///< what was thrown, if the finder gave up
  bool is_unlisted() const;  ///< whether something of what is missing is in no list
  bool is_null() const { return wanted.empty(); }
  /// The part of what the effects make that is left in the channel where they show most; nothing if the finder gave up.
  std::optional<double> left() const;
  /// Largest `after` of all channels, in sensor noise.
  std::optional<double> over_noise() const;
};

/// Explains the case in a folder (case.hpp) from its files and compares with what was kept from the finder. Errors of the
/// finder are part of the judgement; throws FileError if the folder is no case.
/// With a `similarity` the case is that of a rig of another size: model and records in memory are, the figures in sensor
/// noise stay.
Judgement judge(const std::filesystem::path& folder, unsigned threads,
                const std::optional<Similarity>& similarity = std::nullopt);

/// All records (.csv) of a folder, in the order of their names. Throws FileError if one is bad.
std::vector<Record> given_records(const std::filesystem::path& folder);

/// Rms of a model against a noise-free record by channel, in units of the sensor noise. Load pressure is not scored.
std::map<std::string, double> errors_of(const ModelFile& model, const Record& truth,
                                        const std::map<std::string, double>& noise);

/// One line for a person.
std::string line_of(const Judgement& judgement);

nlohmann::json json_of(const Judgement& judgement);

}  // namespace hotfire::study
