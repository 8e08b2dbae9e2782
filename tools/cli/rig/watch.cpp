// SPDX-License-Identifier: Apache-2.0
#include <malloc.h>

#include <csignal>
#include <iostream>
#include <memory>
#include <string>

#include "tools/cli/shared/commands.hpp"
#include "tools/watch/server.hpp"

namespace hotfire {

namespace {

struct WatchOptions {
  std::string file;
  std::string address = "127.0.0.1";
  unsigned port = 8137;
};

/// Blocks of this size and more go back to the system as soon as they are free [bytes]: glibc's own first value, which it
/// raises to the largest block that it has seen. The server would keep the memory of the largest answer, that to a page
/// which asks late.
constexpr int kReturnedBlock = 128 * 1024;

void watch_until_stopped(const WatchOptions& options) {
  mallopt(M_MMAP_THRESHOLD, kReturnedBlock);
  sigset_t stops;
  sigemptyset(&stops);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    sigaddset(&stops, signal);
  }
  // Before any thread is started, so that all of them leave these signals to this one.
  pthread_sigmask(SIG_BLOCK, &stops, nullptr);
  const watch::Watcher watcher(options.file);
  const watch::Server server(watcher, options.address, static_cast<std::uint16_t>(options.port));
  std::cout << server.url() << std::endl;
  std::cerr << "hotfire: open this address in a browser; Ctrl-C ends the page, not the program that it shows\n";
  int signal = 0;
  sigwait(&stops, &signal);
}

}  // namespace

void add_watch(CLI::App& program) {
  const auto options = std::make_shared<WatchOptions>();
  CLI::App* command = program.add_subcommand("watch", "Show a running plant, lab or controller in a browser");
  command
      ->add_option("FILE", options->file,
                   "live-view file of the running program: the file of its option --watch; the program may start later")
      ->required();
  command->add_option("--port", options->port, "TCP port of the page; 0: any free port")
      ->check(CLI::Range(0U, 65535U))
      ->capture_default_str();
  command->add_option("--address", options->address,
                      "IP address of the page; default 127.0.0.1, which only this machine reaches. With another address, "
                      "anyone who reaches it can read the page");
  command->footer(
      "Example: hotfire plant --model explained.toml --bus sim --watch /dev/shm/plant\n         hotfire watch "
      "/dev/shm/plant\nThe command prints the address of the page and serves the page until Ctrl-C. The page only "
      "displays: it changes nothing in the running program. That program may end and start again.");
  command->callback([options] { watch_until_stopped(*options); });
}

}  // namespace hotfire
