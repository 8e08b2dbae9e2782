// SPDX-License-Identifier: Apache-2.0
// hotfire-disperse-mpi WORDS...: `hotfire disperse WORDS` with its draws spread over the ranks of an MPI job.
//
// Each rank runs `hotfire disperse` for its share of the draws and keeps the results in its own folder --out. The results
// then go to rank 0, which writes table and pictures of all. This program knows nothing of draws: it starts `hotfire`, which
// lies beside it or in the path, and carries text.
#include <mpi.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace {

constexpr int kWrongUse = 2;
constexpr int kCannotStart = 127;
/// The most bytes of one message: an MPI count is an int.
constexpr std::uint64_t kMostBytes = 1U << 26U;

/// `hotfire` beside this program, else the one in the path.
std::string program_of_host() {
  std::error_code failed;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::filesystem::path beside = own.parent_path() / "hotfire";
  return !failed && std::filesystem::exists(beside, failed) ? beside.string() : "hotfire";
}

struct Pipe {
  int read = -1;
  int write = -1;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    std::perror("hotfire-disperse-mpi: pipe");
    MPI_Abort(MPI_COMM_WORLD, kCannotStart);
  }
  return {ends[0], ends[1]};
}

[[noreturn]] void become(std::vector<std::string> words, pid_t parent) {
  // A job that is killed must not leave its draws running.
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) {
    std::_Exit(kCannotStart);
  }
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  execvp(arguments.front(), arguments.data());
  std::perror("hotfire-disperse-mpi: hotfire");
  std::_Exit(kCannotStart);
}

int status_of(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string everything_from(int descriptor) {
  std::string text;
  std::array<char, 1U << 16U> block{};
  for (;;) {
    const ssize_t count = read(descriptor, block.data(), block.size());
    if (count > 0) {
      text.append(block.data(), static_cast<std::size_t>(count));
    } else if (count == 0 || errno != EINTR) {
      return text;
    }
  }
}

/// A program that runs beside this one, and our end of the pipe to it.
struct Child {
  pid_t process = -1;
  int ours = -1;
};

/// Starts a program whose standard input or output, `stream`, is a pipe from or to this one.
Child start(const std::vector<std::string>& words, int stream) {
  const Pipe pipe = make_pipe();
  const bool is_input = stream == STDIN_FILENO;
  const int theirs = is_input ? pipe.read : pipe.write;
  const int ours = is_input ? pipe.write : pipe.read;
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) {
    std::perror("hotfire-disperse-mpi: fork");
    MPI_Abort(MPI_COMM_WORLD, kCannotStart);
  }
  if (child == 0) {
    dup2(theirs, stream);
    close(ours);
    close(theirs);
    become(words, parent);
  }
  close(theirs);
  return {child, ours};
}

/// Runs a program and gives what it prints.
int run_printing(const std::vector<std::string>& words, std::string& printed) {
  const Child child = start(words, STDOUT_FILENO);
  printed = everything_from(child.ours);
  close(child.ours);
  return status_of(child.process);
}

/// Runs a program that is given a text on its standard input.
int run_reading(const std::vector<std::string>& words, const std::string& text) {
  const Child child = start(words, STDIN_FILENO);
  // A program that ends early says so by its status.
  std::signal(SIGPIPE, SIG_IGN);
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(child.ours, text.data() + sent, text.size() - sent);
    if (count < 0 && errno != EINTR) {
      break;
    }
    sent += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
  }
  close(child.ours);
  return status_of(child.process);
}

void send(const std::string& text, int to) {
  std::uint64_t size = text.size();
  MPI_Send(&size, 1, MPI_UINT64_T, to, 0, MPI_COMM_WORLD);
  for (std::uint64_t sent = 0; sent < size; sent += kMostBytes) {
    const auto count = static_cast<int>(std::min(kMostBytes, size - sent));
    MPI_Send(text.data() + sent, count, MPI_CHAR, to, 0, MPI_COMM_WORLD);
  }
}

std::string receive(int from) {
  std::uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  std::string text(size, '\0');
  for (std::uint64_t got = 0; got < size; got += kMostBytes) {
    const auto count = static_cast<int>(std::min(kMostBytes, size - got));
    MPI_Recv(text.data() + got, count, MPI_CHAR, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  }
  return text;
}

int run(int rank, int ranks, const std::vector<std::string>& words) {
  const auto command = [&words](const std::vector<std::string>& options) {
    std::vector<std::string> line{program_of_host(), "disperse"};
    line.insert(line.end(), options.begin(), options.end());
    line.insert(line.end(), words.begin(), words.end());
    return line;
  };
  std::string printed;
  int status =
      run_printing(command({"--share", std::to_string(rank + 1) + "/" + std::to_string(ranks), "--print-draws"}), printed);
  // Draws that failed are results as well; the last step counts them.
  int worst = status == 1 ? 0 : status;
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  if (worst != 0) {
    return worst;
  }
  if (rank != 0) {
    send(printed, 0);
    MPI_Bcast(&status, 1, MPI_INT, 0, MPI_COMM_WORLD);
    return status;
  }
  for (int from = 1; from < ranks; ++from) {
    printed += receive(from);
  }
  status = run_reading(command({"--merge", "-"}), printed);
  MPI_Bcast(&status, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty() || words.front() == "--help") {
    std::fputs(
        "Usage: mpirun [OPTIONS OF MPIRUN] hotfire-disperse-mpi WORDS OF hotfire disperse\n"
        "Runs 'hotfire disperse' with its draws spread over the ranks of an MPI job; see 'hotfire disperse --help'.\n"
        "Example: mpirun -n 8 hotfire-disperse-mpi --model taos.toml --out spread -- step --axis pitch\n",
        words.empty() ? stderr : stdout);
    return words.empty() ? kWrongUse : 0;
  }
  MPI_Init(&argc, &argv);
  int rank = 0;
  int ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const int status = run(rank, ranks, words);
  MPI_Finalize();
  return status;
}
