// SPDX-License-Identifier: Apache-2.0
#include "tools/files/import/apart.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>
#include <system_error>

#include "tools/files/text/error.hpp"

namespace hotfire {

namespace {

/// The first byte of what the child says.
constexpr char kResult = 'r';
constexpr char kRefusal = 'f';
constexpr char kFailure = 'e';

void limit(int resource, std::size_t most) {
  const rlimit both{most, most};
  setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

void say(int pipe, char kind, std::string_view text) {
  std::string all(1, kind);
  all += text;
  for (std::string_view rest = all; !rest.empty();) {
    const ssize_t written = write(pipe, rest.data(), rest.size());
    if (written < 0 && errno != EINTR) {
      _exit(1);
    }
    rest.remove_prefix(written < 0 ? 0 : static_cast<std::size_t>(written));
  }
}

[[noreturn]] void be_the_child(const std::function<std::string()>& work, const ApartLimits& limits, int pipe) {
  for (const int crash : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU}) {
    std::signal(crash, SIG_DFL);
  }
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.processor_seconds);
#ifndef __SANITIZE_ADDRESS__
  limit(RLIMIT_AS, limits.memory_mib << 20U);
#endif
  try {
    say(pipe, kResult, work());
  } catch (const FileError& error) {
    say(pipe, kRefusal, error.what());
  } catch (const std::bad_alloc&) {
    say(pipe, kFailure, fmt::format("it takes more than {} MiB of memory", limits.memory_mib));
  } catch (const std::exception& error) {
    say(pipe, kFailure, error.what());
  }
  _exit(0);
}

/// All that the child says, up to the limit.
std::string heard(int pipe, std::size_t most, bool& too_much) {
  std::string text;
  std::array<char, 1 << 16> piece{};
  for (;;) {
    const ssize_t got = read(pipe, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      return text;
    }
    text.append(piece.data(), static_cast<std::size_t>(got));
    too_much = text.size() > most + 1;
    if (too_much) {
      return text;
    }
  }
}

std::string death_of(int status, const ApartLimits& limits) {
  if (!WIFSIGNALED(status)) {
    return fmt::format("its reader ended with status {}", WEXITSTATUS(status));
  }
  if (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL) {
    return fmt::format("it takes more than {} s to read", limits.processor_seconds);
  }
  return fmt::format("its reader crashed (signal {}, {})", WTERMSIG(status), strsignal(WTERMSIG(status)));
}

}  // namespace

std::string run_apart(const std::function<std::string()>& work, const ApartLimits& limits) {
  std::array<int, 2> pipe{};
  if (pipe2(pipe.data(), O_CLOEXEC) != 0) {
    throw ApartError(fmt::format("no pipe: {}", std::generic_category().message(errno)));
  }
  const pid_t child = fork();
  if (child < 0) {
    const int why = errno;
    close(pipe[0]);
    close(pipe[1]);
    throw ApartError(fmt::format("no process to read it in: {}", std::generic_category().message(why)));
  }
  if (child == 0) {
    close(pipe[0]);
    be_the_child(work, limits, pipe[1]);
  }
  close(pipe[1]);
  bool too_much = false;
  std::string said = heard(pipe[0], limits.result_bytes, too_much);
  close(pipe[0]);
  if (too_much) {
    kill(child, SIGKILL);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (too_much) {
    throw ApartError(fmt::format("it holds more than {} bytes", limits.result_bytes));
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || said.empty()) {
    throw ApartError(death_of(status, limits));
  }
  const char kind = said.front();
  said.erase(0, 1);
  if (kind == kRefusal) {
    throw FileError(said);
  }
  if (kind != kResult) {
    throw ApartError(said);
  }
  return said;
}

}  // namespace hotfire
