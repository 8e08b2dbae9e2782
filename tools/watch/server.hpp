// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tools/watch/watcher.hpp"

struct MHD_Daemon;

namespace hotfire::watch {

/// Serves the page of a watcher by HTTP: `/` is the page, `/data` what it shows. There is nothing else, and nothing can be
/// changed: any method but GET is refused, and so is a request for a host name other than localhost, with which a page of
/// somebody else could read along (DNS rebinding).
class Server {
 public:
  /// `address`: numeric, of one interface of this machine. `port` 0: any that is free. Throws UsageError if it is taken.
  Server(const Watcher& watcher, const std::string& address, std::uint16_t port);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Of the page.
  const std::string& url() const { return url_; }

 private:
  struct Stop {
    void operator()(MHD_Daemon* daemon) const;
  };
  std::unique_ptr<MHD_Daemon, Stop> daemon_;
  std::string url_;
};

/// The page, with everything that it needs. Generated from page/ by the build.
std::string watch_page();

}  // namespace hotfire::watch
