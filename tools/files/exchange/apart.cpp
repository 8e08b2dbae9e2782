// SPDX-License-Identifier: Apache-2.0
#include "tools/files/exchange/apart.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
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

// The address sanitizer maps terabytes, more than any limit on addresses allows: g++ says by a macro that it is there,
// clang++ by a feature.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool kAddressesAreSanitized = true;
#elif defined(__has_feature)
constexpr bool kAddressesAreSanitized = __has_feature(address_sanitizer);
#else
constexpr bool kAddressesAreSanitized = false;
#endif

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
  if (!kAddressesAreSanitized) {
    limit(RLIMIT_AS, limits.memory_mib << 20U);
  }
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

enum class Ended { said_all, too_much, too_late };

/// All that the child says, up to the limits.
Ended hear(int pipe, const ApartLimits& limits, std::string& text) {
  const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(limits.seconds);
  std::array<char, 1 << 16> piece{};
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(latest - std::chrono::steady_clock::now());
    pollfd readable{pipe, POLLIN, 0};
    const int ready = poll(&readable, 1, static_cast<int>(std::max<std::int64_t>(left.count(), 0)));
    if (ready == 0) {
      return Ended::too_late;
    }
    const ssize_t got = ready < 0 ? -1 : read(pipe, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      return Ended::said_all;
    }
    text.append(piece.data(), static_cast<std::size_t>(got));
    if (text.size() > limits.result_bytes + 1) {
      return Ended::too_much;
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
  std::string said;
  const Ended ended = hear(pipe[0], limits, said);
  close(pipe[0]);
  if (ended != Ended::said_all) {
    kill(child, SIGKILL);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (ended == Ended::too_late) {
    throw ApartError(fmt::format("its reader has not ended after {} s", limits.seconds));
  }
  if (ended == Ended::too_much) {
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
