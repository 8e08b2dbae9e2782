// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <ctime>
#include <functional>
#include <string>

namespace hotfire::explain {

/// What a search does, in the order of one that finds an effect. Terms of unknown law are searched for if the listed effects
/// leave something.
enum class Work { calibrating, locating, screening, fitting, deciding, settling, unlisted, concluding };

/// What is being done, for a person who waits.
struct Doing {
  Work work;
  std::string what;                  ///< in words
  double share = 0.0;                ///< of this work that is done, 0 to 1, as far as it is known
  std::size_t searches_to_come = 0;  ///< whole searches that follow this one: of the other axis
};

/// Shares of a work that are done when a part of it ends, as two searches of one effect took their time (the cases
/// `friction` and `soft` of tests/data/challenge). Nothing but a bar depends on them.
struct SharesOfWork {
  static constexpr double kFittedAlone = 0.3;            ///< of fitting: the best candidates, beside frozen others
  static constexpr double kFittedWithAll = 0.8;          ///< of fitting: the finalists, with everything else
  static constexpr double kProposed = 0.5;               ///< of terms of unknown law
  static constexpr double kComparedWithBlackBox = 0.25;  ///< of the conclusion
  static constexpr double kFittedBesideAxis = 0.5;       ///< of the conclusion, for two axes
  static constexpr double kFittedToAllRows = 0.9;        ///< of the conclusion
};

/// How a search reports what it is doing, and how it is stopped.
struct Watch {
  /// From any thread, and from one at a time.
  std::function<void(const Doing&)> progress = [](const Doing&) {};
  std::function<bool()> interrupted = [] { return false; };
};

/// Time since it was made [s]: on the wall, and of the processor by all threads of the program.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count(); }
  double processor_seconds() const { return static_cast<double>(std::clock() - processor_began_) / CLOCKS_PER_SEC; }

 private:
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::clock_t processor_began_ = std::clock();
};

}  // namespace hotfire::explain
