// SPDX-License-Identifier: Apache-2.0
// Runs hotfire-rt as a service manager does, with a notify socket and a watchdog: service_program HOTFIRE-RT FOLDER-OF-UNITS
#include <sys/wait.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <vector>

#include "tests/firmware/recording/recorded_run.hpp"
#include "tests/support/notify_socket.hpp"

namespace hotfire {
namespace {

constexpr int kPatienceMs = 30'000;

int failures = 0;

void expect(bool good, const char* what) {
  std::printf("%s: %s\n", good ? "good" : "FAILED", what);
  failures += good ? 0 : 1;
}

void check_the_program(const std::string& program, const std::filesystem::path& folder) {
  std::ofstream(folder / "bench.image") << test::kBenchImage;
  const test::NotifySocket socket(folder / "notify");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    setenv("NOTIFY_SOCKET", socket.address().c_str(), 1);
    setenv("WATCHDOG_USEC", "200000", 1);
    setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
    const std::string image = folder / "bench.image";
    execl(program.c_str(), program.c_str(), "plant", "--image", image.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  expect(socket.next(kPatienceMs).starts_with("READY=1\nWATCHDOG=1"), "ready when the loop turns");
  bool fed = true;
  for (int i = 0; i < 5; ++i) {
    fed = fed && socket.next(kPatienceMs).starts_with("WATCHDOG=1");
  }
  expect(fed, "the watchdog is fed while it turns");
  kill(child, SIGTERM);
  int status = 0;
  waitpid(child, &status, 0);
  std::string last;
  for (std::string next = socket.next(0); !next.empty(); next = socket.next(0)) {
    last = next;
  }
  expect(last == "STOPPING=1", "the last word is that it is stopping");
  expect(WIFEXITED(status) && WEXITSTATUS(status) == 0, "it ends well on SIGTERM");
}

void check_the_unit(const std::string& path, std::initializer_list<const char*> own) {
  std::ifstream file(path);
  const std::string unit{std::istreambuf_iterator<char>(file), {}};
  std::vector<const char*> lines{"\nType=notify\n", "\nWatchdogSec=", "\nLimitRTPRIO=99\n", "\nLimitMEMLOCK=infinity\n",
                                 "CAP_SYS_NICE CAP_IPC_LOCK"};
  lines.insert(lines.end(), own);
  for (const char* line : lines) {
    expect(unit.find(line) != std::string::npos, line);
  }
  expect(unit.find('@') == std::string::npos || unit.find("@CMAKE") == std::string::npos, "every path is filled in");
}

}  // namespace
}  // namespace hotfire

int main(int count, char** values) {
  if (count != 3) {
    std::fprintf(stderr, "usage: %s HOTFIRE-RT FOLDER-OF-UNITS\n", values[0]);
    return 2;
  }
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("hotfire-service-" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  hotfire::check_the_program(values[1], folder);
  const std::string units = values[2];
  hotfire::check_the_unit(units + "/hotfire-plant@.service", {"/hotfire plant --model /etc/hotfire/%i.toml",
                                                              "/hotfire-rt plant --image /etc/hotfire/%i.image"});
  // What ended by itself, or by an interlock, is not started anew.
  hotfire::check_the_unit(units + "/hotfire-lab@.service",
                          {"/hotfire lab --profile /etc/hotfire/%i.toml", "/hotfire-rt lab --image /etc/hotfire/%i.image",
                           " CAP_NET_ADMIN\n", "\nRestart=on-abnormal\n"});
  std::filesystem::remove_all(folder);
  return hotfire::failures == 0 ? 0 : 1;
}
