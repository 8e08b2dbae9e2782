// SPDX-License-Identifier: Apache-2.0
// hotfire-disperse-mpi WORDS...: `hotfire disperse WORDS` with its draws spread over the ranks of an MPI job.
//
// Each rank runs `hotfire disperse --worker`, which keeps its results in its own folder --out. Rank 0 hands out the draws in
// blocks, to its own worker as well, and gives all results to its own worker, which writes table and pictures. This program
// knows nothing of what is drawn: it starts `hotfire`, which lies beside it or in the path, and carries lines. A rank that
// waits sleeps, so that it takes no processor from a worker.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tools/disperse/mpi/draws_at_hand.hpp"
#include "tools/disperse/mpi/worker_process.hpp"

namespace hotfire {

namespace {

constexpr int kWrongUse = 2;
/// The most bytes of one message: an MPI count is an int.
constexpr std::uint64_t kMostBytes = 1U << 26U;
/// How long a rank sleeps before it looks for a message. It asks while its worker still has a draw to run, which hides this
/// time. Each look interrupts a worker on the same processor: 500 of them a second took a fifth of it on a virtual machine.
constexpr int kLook = 20;  // ms
/// Draws that a worker still has when it is given the next block: it goes on while its rank asks.
constexpr int kAhead = 1;

/// What a message is.
enum class Kind : int {
  asks = 1,  ///< to rank 0: what the worker printed; the next draws are wanted
  ends,      ///< to rank 0: a line with the worker's exit status, then what it printed
  draws,     ///< to a rank: numbers of its next draws, a line each; none: there are no more
  status,    ///< to a rank: the exit status of the job
  part,      ///< of the text of the message before
};

void send(const std::string& text, int to, Kind kind) {
  std::uint64_t size = text.size();
  MPI_Send(&size, 1, MPI_UINT64_T, to, static_cast<int>(kind), MPI_COMM_WORLD);
  for (std::uint64_t sent = 0; sent < size; sent += kMostBytes) {
    const auto count = static_cast<int>(std::min(kMostBytes, size - sent));
    MPI_Send(text.data() + sent, count, MPI_CHAR, to, static_cast<int>(Kind::part), MPI_COMM_WORLD);
  }
}

struct Message {
  int from = 0;
  Kind kind = Kind::asks;
  std::string text{};
};

/// True if a message of this kind is there; its sender in `from`.
bool is_there(Kind kind, int& from) {
  int found = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, static_cast<int>(kind), MPI_COMM_WORLD, &found, &status);
  from = found != 0 ? status.MPI_SOURCE : from;
  return found != 0;
}

Message receive(int from, Kind kind) {
  std::uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, from, static_cast<int>(kind), MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  Message message{from, kind, std::string(size, '\0')};
  for (std::uint64_t got = 0; got < size; got += kMostBytes) {
    const auto count = static_cast<int>(std::min(kMostBytes, size - got));
    MPI_Recv(message.text.data() + got, count, MPI_CHAR, from, static_cast<int>(Kind::part), MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
  }
  return message;
}

void sleep() { std::this_thread::sleep_for(std::chrono::milliseconds(kLook)); }

/// A message of rank 0, for which this rank sleeps: a wait of MPI itself takes a whole processor.
std::string awaited(Kind kind) {
  int from = 0;
  while (!is_there(kind, from)) {
    sleep();
  }
  return receive(0, kind).text;
}

std::string lines_of(const std::vector<int>& draws) {
  std::string text;
  for (const int draw : draws) {
    text += std::to_string(draw) + '\n';
  }
  return text;
}

/// A worker, and how many draws it still has.
class Worker {
 public:
  explicit Worker(const std::vector<std::string>& words) : process_(words) {}

  /// Takes what it has printed: the line of its inputs, the line of its draws, then a line for each draw.
  std::string printed() {
    std::string text;
    while (const auto line = process_.line()) {
      heads_ < kHeads ? ++heads_ : --left_;
      text += *line;
    }
    return text;
  }

  bool is_ready() const { return heads_ == kHeads; }
  bool wants_draws() const { return is_ready() && left_ <= kAhead; }
  bool is_idle() const { return is_ready() && left_ == 0; }

  void give_draws(const std::string& lines) {
    left_ += std::count(lines.begin(), lines.end(), '\n');
    process_.give(lines);
  }

  /// Its exit status; that of a failure if it has ended before its draws were done.
  int end(bool is_done) {
    const int status = process_.status();
    return is_done || status != 0 ? status : kCannotStart;
  }

  WorkerProcess& process() { return process_; }

 private:
  static constexpr int kHeads = 2;
  WorkerProcess process_;
  int heads_ = 0;
  std::ptrdiff_t left_ = 0;
};

/// A rank that rank 0 gives draws.
int follow(const std::vector<std::string>& words) {
  Worker worker(words);
  std::string ready;
  bool is_over = false;
  bool runs = true;
  while (runs) {
    runs = worker.process().wait(kLook);
    ready += worker.printed();
    if (runs && !is_over && worker.wants_draws()) {
      send(std::exchange(ready, {}), 0, Kind::asks);
      const std::string draws = awaited(Kind::draws);
      worker.give_draws(draws);
      is_over = draws.empty();
    }
    if (is_over && worker.is_idle()) {
      worker.process().close_input();
    }
  }
  const bool is_done = is_over && worker.is_idle();
  send(std::to_string(worker.end(is_done)) + '\n' + ready, 0, Kind::ends);
  return std::stoi(awaited(Kind::status));
}

/// Rank 0: its own worker, and what it knows of the others.
class Leader {
 public:
  Leader(const std::vector<std::string>& words, int ranks) : worker_(words), ranks_(static_cast<std::size_t>(ranks)) {}

  int run() {
    while (!is_over()) {
      attend_to_own();
      attend_to_others();
      hand_out();
    }
    if (worst_ == 0) {
      worker_.process().give("report\n");
    }
    worker_.process().close_input();
    while (worker_.process().wait(kLook)) {
    }
    const std::string printed = worker_.process().rest();
    std::fwrite(printed.data(), 1, printed.size(), stdout);
    const int status = ranks_.front().has_ended ? worst_ : worker_.end(true);
    return worst_ == 0 ? status : worst_;
  }

 private:
  struct Rank {
    bool is_known = false;   ///< it has said which draws it has
    bool asks = false;       ///< for draws
    bool is_out = false;     ///< it knows that there are no more
    bool has_ended = false;  ///< its worker
  };

  bool is_over() const {
    const bool own = ranks_.front().has_ended || (ranks_.front().is_out && worker_.is_idle());
    return own && std::all_of(ranks_.begin() + 1, ranks_.end(), [](const Rank& rank) { return rank.has_ended; });
  }

  void attend_to_own() {
    Rank& own = ranks_.front();
    if (own.has_ended) {
      sleep();
      return;
    }
    const bool runs = worker_.process().wait(kLook);
    const std::string printed = worker_.printed();
    if (!own.is_known && worker_.is_ready()) {
      learn(0, printed);
    }
    own.asks = worker_.wants_draws() && !own.is_out;
    if (!runs) {
      own = {true, false, true, true};
      worst_ = std::max(worst_, worker_.end(false));
    }
  }

  void attend_to_others() {
    // What others have is compared with what rank 0 has.
    for (int from = 0; ranks_.front().is_known && is_there(Kind::asks, from);) {
      const std::string text = receive(from, Kind::asks).text;
      Rank& rank = ranks_[static_cast<std::size_t>(from)];
      rank.asks = true;
      take(from, text);
    }
    for (int from = 0; ranks_.front().is_known && is_there(Kind::ends, from);) {
      const std::string text = receive(from, Kind::ends).text;
      Rank& rank = ranks_[static_cast<std::size_t>(from)];
      const std::size_t end = text.find('\n') + 1;
      const int status = std::stoi(text);
      if (rank.is_known) {
        take(from, text.substr(end));
      }
      rank = {true, false, true, true};
      worst_ = std::max(worst_, status);
    }
  }

  /// What a worker printed goes to that of rank 0.
  void take(int from, const std::string& text) {
    if (ranks_[static_cast<std::size_t>(from)].is_known) {
      worker_.process().give(text);
    } else {
      learn(from, text);
    }
  }

  /// The lines with which a worker begins: its inputs, then the number of the draws and those that it has.
  void learn(int from, const std::string& text) {
    const std::size_t end = text.find('\n') + 1;
    if (from != 0) {
      worker_.process().give(text.substr(0, end));
    }
    std::istringstream numbers(text.substr(end));
    int last = 0;
    numbers >> last;
    if (!draws_) {
      draws_.emplace(last, static_cast<int>(ranks_.size()));
    }
    std::vector<int> had;
    for (int draw = 0; numbers >> draw;) {
      had.push_back(draw);
    }
    draws_->has(from, had);
    ranks_[static_cast<std::size_t>(from)].is_known = true;
  }

  /// Draws for those who ask, once it is known who has which.
  void hand_out() {
    if (!std::all_of(ranks_.begin(), ranks_.end(), [](const Rank& rank) { return rank.is_known; })) {
      return;
    }
    for (std::size_t i = 0; i < ranks_.size(); ++i) {
      if (!ranks_[i].asks) {
        continue;
      }
      ranks_[i].asks = false;
      // After a failure there will be no table.
      const std::string draws = worst_ == 0 ? lines_of(draws_->take(static_cast<int>(i))) : std::string();
      ranks_[i].is_out = draws.empty();
      if (i == 0) {
        worker_.give_draws(draws);
      } else {
        send(draws, static_cast<int>(i), Kind::draws);
      }
    }
  }

  Worker worker_;
  std::vector<Rank> ranks_;
  std::optional<DrawsAtHand> draws_{};
  int worst_ = 0;  ///< exit status of a worker
};

/// `hotfire` beside this program, else the one in the path.
std::string program_of_host() {
  std::error_code failed;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::filesystem::path beside = own.parent_path() / "hotfire";
  return !failed && std::filesystem::exists(beside, failed) ? beside.string() : "hotfire";
}

int run(int rank, int ranks, const std::vector<std::string>& words) {
  std::vector<std::string> line{program_of_host(), "disperse", "--worker", "--share",
                                std::to_string(rank + 1) + "/" + std::to_string(ranks)};
  line.insert(line.end(), words.begin(), words.end());
  if (rank != 0) {
    return follow(line);
  }
  const int status = Leader(line, ranks).run();
  for (int to = 1; to < ranks; ++to) {
    send(std::to_string(status), to, Kind::status);
  }
  return status;
}

}  // namespace

}  // namespace hotfire

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty() || words.front() == "--help") {
    std::fputs(
        "Usage: mpirun [OPTIONS OF MPIRUN] hotfire-disperse-mpi WORDS OF hotfire disperse\n"
        "Runs 'hotfire disperse' with its draws spread over the ranks of an MPI job; see 'hotfire disperse --help'.\n"
        "Rank 0 hands out the draws in blocks, so that a slower rank has fewer of them.\n"
        "Example: mpirun -n 8 hotfire-disperse-mpi --model taos.toml --out spread -- step --axis pitch\n",
        words.empty() ? stderr : stdout);
    return words.empty() ? hotfire::kWrongUse : 0;
  }
  MPI_Init(&argc, &argv);
  int rank = 0;
  int ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const int status = hotfire::run(rank, ranks, words);
  MPI_Finalize();
  return status;
}
