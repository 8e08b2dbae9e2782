// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace hotfire::disperse {

/// A part of the draws: those whose number leaves `index` - 1 on division by `count`.
struct Share {
  int index = 1;  ///< from 1
  int count = 1;

  bool has(int draw) const { return draw % count == index - 1; }
};

/// What one draw gave.
struct DrawResult {
  int draw = 0;                        ///< from 1; 0: the declared model
  std::string model = {};              ///< SHA-256 of the text of its model
  int status = 0;                      ///< exit status of the command
  std::string complaint = {};          ///< what a command that failed said
  nlohmann::ordered_json result = {};  ///< what it printed
  nlohmann::ordered_json channels =
      {};  ///< of its record: least, greatest and last value of a channel, and some of its rows
};

/// The results of a dispersion so far, in files of one folder, one for each share. A file is a line with the inputs, then a
/// line for each draw; a line begins with the first 16 digits of the SHA-256 of its rest. A line that a kill has cut is
/// dropped, and every other line that was changed is refused.
class DrawStore {
 public:
  /// Opens the folder, reads the results of all shares in it and locks the file of its own share. `inputs` is an object of
  /// everything that the results follow from. Throws FileError for results of other inputs, which names what differs, for a
  /// damaged line, for two different results of a draw, and if another process works on the same share.
  DrawStore(const std::filesystem::path& folder, const nlohmann::ordered_json& inputs, Share share);
  ~DrawStore();
  DrawStore(const DrawStore&) = delete;
  DrawStore& operator=(const DrawStore&) = delete;

  /// By draw.
  const std::map<int, DrawResult>& results() const { return results_; }

  /// Writes one more result; it survives a kill of the process.
  void add(const DrawResult& result);

  /// Takes the results of another store of the same inputs, as `text` gives them. `name` represents it in messages. Throws
  /// FileError as above.
  void merge(std::string_view text, const std::string& name);

  /// The same for one of its lines.
  void merge_line(std::string_view line, const std::string& name);

  /// The line with the inputs, and that of a draw that has a result.
  const std::string& header() const { return header_; }
  std::string line(int draw) const;

  /// The results of a share as its file has them, in the order of the draws.
  std::string text(Share share) const;

 private:
  enum class From { folder, text, line };
  void read(std::string_view text, const std::string& name, From from);
  void read_own_file();
  void append(const std::string& line) const;

  std::filesystem::path file_;
  std::string header_;
  std::map<int, DrawResult> results_;
  int descriptor_ = -1;
};

}  // namespace hotfire::disperse
