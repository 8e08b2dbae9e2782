// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tools/watch/history.hpp"
#include "tools/watch/live_source.hpp"

namespace hotfire::watch {

/// What a page asks for.
struct Request {
  std::string epoch;                  ///< of its last answer: which program it has rows of; empty: none yet
  std::uint64_t row = 0;              ///< the first row that it does not have
  std::vector<std::size_t> channels;  ///< whose values it wants
};

/// Follows a live view by a thread of its own, whether a page is open or not, and answers pages. One reader serves them all:
/// their number changes nothing for the program that is watched.
class Watcher {
 public:
  explicit Watcher(const std::string& path);
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// JSON (docs/interfaces/watch.md). If the program is another one than the page has rows of, it describes the program and
  /// begins with the oldest row. From any thread.
  std::string answer(const Request& request) const;

 private:
  using Clock = std::chrono::steady_clock;

  void follow();
  void take_cycles();

  std::string path_;
  mutable std::mutex mutex_;
  std::condition_variable stop_asked_;
  bool stopping_ = false;
  LiveSource source_;
  History history_;
  std::string started_;        ///< when this watcher began: the first part of every epoch
  std::uint64_t program_ = 0;  ///< number of the program that is there; 0: none yet
  Clock::time_point last_cycle_at_;
  std::thread thread_;
};

}  // namespace hotfire::watch
