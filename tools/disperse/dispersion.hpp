// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/disperse/declared_model.hpp"
#include "tools/disperse/draw_store.hpp"
#include "tools/disperse/tolerances.hpp"

namespace hotfire::disperse {

/// What a command line of `hotfire` gave.
struct CommandOutcome {
  int status = 0;
  std::string printed;
  std::string complained;
};

/// Runs one command line of `hotfire`, without the word `hotfire`.
using CommandRunner = std::function<CommandOutcome(const std::vector<std::string>&)>;

/// The word of a command line that is replaced by the number of the draw.
inline constexpr std::string_view kDrawWord = "{draw}";

/// What is drawn, and what is run for each draw.
struct Plan {
  std::filesystem::path model = {};
  std::filesystem::path tolerances = {};   ///< empty: those of the model file
  std::vector<std::string> command = {};   ///< without --model, --json
  std::vector<std::string> channels = {};  ///< of the record of a draw, kept for pictures over time
  int draws = 1000;
  std::uint64_t seed = 1;
  std::string program = {};  ///< digest of the program that runs the commands
};

/// Draws of a model and their results in a folder.
class Dispersion {
 public:
  /// Reads model and tolerances, draws, and opens the folder of results. Throws FileError as DeclaredModel, load_tolerances
  /// and DrawStore do, and UsageError for a command that cannot be run per draw.
  Dispersion(Plan plan, const std::filesystem::path& folder, Share share);

  /// Runs the command for every draw of its share, and for the declared model, as far as there is no result.
  /// `progress(done, all)` is called after each. Throws UsageError for a command that is used wrongly, FileError if the
  /// declared model itself cannot be run, both with what the command said.
  void run(const CommandRunner& run, const std::function<void(int, int)>& progress);

  /// The same for one draw of any share. `scratch` is a folder for its files.
  void run(int draw, const CommandRunner& run, const std::filesystem::path& scratch);

  const Plan& plan() const { return plan_; }
  const Tolerances& tolerances() const { return tolerances_; }
  DrawStore& store() { return store_; }
  const DrawStore& store() const { return store_; }

  /// The value that each tolerance gives in a draw; of draw 0 the declared one.
  std::vector<double> values(int draw) const;

  /// True if every draw of the plan has a result.
  bool is_complete() const;

 private:
  Eigen::VectorXd variables(int draw) const;
  std::string model_digest(int draw) const;
  DrawResult result_of(int draw, const CommandRunner& run, const std::filesystem::path& scratch) const;
  nlohmann::ordered_json inputs() const;

  Plan plan_;
  DeclaredModel model_;
  Tolerances tolerances_;
  Eigen::MatrixXd sample_;  ///< probabilities, a row a draw
  Share share_;
  DrawStore store_;
};

}  // namespace hotfire::disperse
