// SPDX-License-Identifier: Apache-2.0
#include "tools/watch/server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <microhttpd.h>
#include <netinet/in.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include "tools/files/text/error.hpp"

namespace hotfire::watch {
namespace {

constexpr unsigned kMostConnections = 64;
constexpr unsigned kIdleSeconds = 30;
/// Wanted channels of a request, at most.
constexpr std::size_t kMostWanted = 256;

MHD_Result reply(MHD_Connection* connection, unsigned status, std::string_view type, std::string_view body) {
  MHD_Response* const response =
      MHD_create_response_from_buffer(body.size(), const_cast<char*>(body.data()), MHD_RESPMEM_MUST_COPY);
  if (response == nullptr) {
    return MHD_NO;
  }
  MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, std::string(type).c_str());
  MHD_add_response_header(response, MHD_HTTP_HEADER_CACHE_CONTROL, "no-store");
  MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
  if (status == MHD_HTTP_METHOD_NOT_ALLOWED) {
    MHD_add_response_header(response, MHD_HTTP_HEADER_ALLOW, MHD_HTTP_METHOD_GET);
  }
  const MHD_Result result = MHD_queue_response(connection, status, response);
  MHD_destroy_response(response);
  return result;
}

MHD_Result refuse(MHD_Connection* connection, unsigned status, std::string_view why) {
  return reply(connection, status, "text/plain; charset=utf-8", std::string(why) + "\n");
}

/// Whether a `Host` is this machine by a number or as localhost: only a name can be made to lead here by others.
bool is_own(std::string_view host) {
  if (host.starts_with('[')) {
    return true;
  }
  const std::string name(host.substr(0, host.find(':')));
  in_addr parsed{};
  return name == "localhost" || inet_pton(AF_INET, name.c_str(), &parsed) == 1;
}

std::string_view argument(MHD_Connection* connection, const char* name) {
  const char* const value = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, name);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

bool read_number(std::string_view text, std::uint64_t& number) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && stop == text.data() + text.size();
}

/// What /data is asked for: ?epoch=E&row=N&channels=0,3; none if that is not so.
std::optional<Request> request_of(MHD_Connection* connection) {
  Request request;
  request.epoch = argument(connection, "epoch");
  if (const std::string_view row = argument(connection, "row"); !row.empty() && !read_number(row, request.row)) {
    return std::nullopt;
  }
  for (std::string_view rest = argument(connection, "channels"); !rest.empty();) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    std::uint64_t channel = 0;
    if (!read_number(rest.substr(0, end), channel) || request.channels.size() == kMostWanted) {
      return std::nullopt;
    }
    request.channels.push_back(channel);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return request;
}

MHD_Result handle(void* context, MHD_Connection* connection, const char* url, const char* method, const char*, const char*,
                  std::size_t*, void** seen) {
  static char mark;
  if (std::string_view(method) != MHD_HTTP_METHOD_GET) {
    return refuse(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "only GET: this page changes nothing");
  }
  // The first call has only the head of the request. An answer then would close the connection.
  if (*seen == nullptr) {
    *seen = &mark;
    return MHD_YES;
  }
  const char* const host = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, MHD_HTTP_HEADER_HOST);
  if (host == nullptr || !is_own(host)) {
    return refuse(connection, MHD_HTTP_FORBIDDEN, "ask by number or as localhost");
  }
  const std::string_view path(url);
  if (path == "/") {
    static const std::string page = watch_page();
    return reply(connection, MHD_HTTP_OK, "text/html; charset=utf-8", page);
  }
  if (path == "/data") {
    const std::optional<Request> request = request_of(connection);
    return request
               ? reply(connection, MHD_HTTP_OK, "application/json", static_cast<const Watcher*>(context)->answer(*request))
               : refuse(connection, MHD_HTTP_BAD_REQUEST, "allowed is ?epoch=TEXT&row=N&channels=N,N");
  }
  return refuse(connection, MHD_HTTP_NOT_FOUND, "there is only / and /data");
}

/// An address of either kind, as the system takes it.
struct Socket {
  sockaddr_in v4{};
  sockaddr_in6 v6{};
  bool is_v6 = false;
  const sockaddr* any() const {
    return is_v6 ? reinterpret_cast<const sockaddr*>(&v6) : reinterpret_cast<const sockaddr*>(&v4);
  }
};

Socket socket_of(const std::string& address, std::uint16_t port) {
  Socket place;
  if (inet_pton(AF_INET, address.c_str(), &place.v4.sin_addr) == 1) {
    place.v4.sin_family = AF_INET;
    place.v4.sin_port = htons(port);
    return place;
  }
  if (inet_pton(AF_INET6, address.c_str(), &place.v6.sin6_addr) == 1) {
    place.is_v6 = true;
    place.v6.sin6_family = AF_INET6;
    place.v6.sin6_port = htons(port);
    return place;
  }
  throw UsageError(fmt::format("--address \"{}\": allowed is a number, 127.0.0.1 or ::1 say", address));
}

}  // namespace

void Server::Stop::operator()(MHD_Daemon* daemon) const { MHD_stop_daemon(daemon); }

Server::Server(const Watcher& watcher, const std::string& address, std::uint16_t port) {
  const Socket place = socket_of(address, port);
  errno = 0;
  daemon_.reset(MHD_start_daemon(
      static_cast<unsigned>(MHD_USE_EPOLL_INTERNAL_THREAD) | (place.is_v6 ? static_cast<unsigned>(MHD_USE_IPv6) : 0U), port,
      nullptr, nullptr, handle, const_cast<Watcher*>(&watcher), MHD_OPTION_SOCK_ADDR, place.any(),
      MHD_OPTION_CONNECTION_LIMIT, kMostConnections, MHD_OPTION_CONNECTION_TIMEOUT, kIdleSeconds, MHD_OPTION_END));
  if (!daemon_) {
    throw UsageError(fmt::format("no page at {} port {}: {}; name another --port, or 0 for any that is free", address, port,
                                 std::strerror(errno)));
  }
  const MHD_DaemonInfo* const bound = MHD_get_daemon_info(daemon_.get(), MHD_DAEMON_INFO_BIND_PORT);
  url_ = fmt::format("http://{}:{}/", place.is_v6 ? "[" + address + "]" : address, bound->port);
}

Server::~Server() = default;

}  // namespace hotfire::watch
