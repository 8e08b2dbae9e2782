// SPDX-License-Identifier: Apache-2.0
#include "tools/disperse/mpi/worker_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace hotfire {

namespace {

[[noreturn]] void refuse(const char* what) {
  std::perror(what);
  std::_Exit(kCannotStart);
}

struct Pipe {
  int read = -1;
  int write = -1;
};

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    refuse("hotfire-disperse-mpi: pipe");
  }
  return {ends[0], ends[1]};
}

[[noreturn]] void become(std::vector<std::string> words, pid_t parent) {
  // A job that is killed must not leave its draws running.
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) {
    std::_Exit(kCannotStart);
  }
  std::signal(SIGPIPE, SIG_DFL);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  execvp(arguments.front(), arguments.data());
  refuse("hotfire-disperse-mpi: hotfire");
}

void close_once(int& descriptor) {
  if (descriptor >= 0) {
    close(descriptor);
    descriptor = -1;
  }
}

}  // namespace

WorkerProcess::WorkerProcess(const std::vector<std::string>& words) {
  // A program that ends early says so by its status.
  std::signal(SIGPIPE, SIG_IGN);
  const Pipe input = make_pipe();
  const Pipe output = make_pipe();
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ < 0) {
    refuse("hotfire-disperse-mpi: fork");
  }
  if (process_ == 0) {
    dup2(input.read, STDIN_FILENO);
    dup2(output.write, STDOUT_FILENO);
    become(words, parent);
  }
  close(input.read);
  close(output.write);
  to_ = input.write;
  from_ = output.read;
  // A worker that computes takes no text for long: this program goes on.
  fcntl(to_, F_SETFL, O_NONBLOCK);
}

WorkerProcess::~WorkerProcess() {
  close_once(to_);
  close_once(from_);
}

bool WorkerProcess::wait(int milliseconds) {
  if (closing_ && pending_.empty()) {
    close_once(to_);
  }
  std::array<pollfd, 2> ends{{{from_, POLLIN, 0}, {pending_.empty() ? -1 : to_, POLLOUT, 0}}};
  if (poll(ends.data(), ends.size(), milliseconds) <= 0) {
    return !ended_;
  }
  if (ends[1].revents != 0) {
    write_pending();
  }
  if (ends[0].revents != 0) {
    std::array<char, 1U << 16U> block{};
    const ssize_t count = read(from_, block.data(), block.size());
    if (count > 0) {
      printed_.append(block.data(), static_cast<std::size_t>(count));
    } else if (count == 0 || errno != EINTR) {
      close_once(from_);
      ended_ = true;
    }
  }
  return !ended_;
}

void WorkerProcess::write_pending() {
  const ssize_t count = write(to_, pending_.data(), pending_.size());
  if (count > 0) {
    pending_.erase(0, static_cast<std::size_t>(count));
  } else if (errno != EINTR && errno != EAGAIN) {
    // It reads no more.
    pending_.clear();
    closing_ = true;
  }
}

std::optional<std::string> WorkerProcess::line() {
  const std::size_t end = printed_.find('\n');
  if (end == std::string::npos) {
    return {};
  }
  std::string line = printed_.substr(0, end + 1);
  printed_.erase(0, end + 1);
  return line;
}

std::string WorkerProcess::rest() { return std::exchange(printed_, {}); }

int WorkerProcess::status() {
  close_once(to_);
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace hotfire
