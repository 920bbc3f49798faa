// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// For LiveServer's own source file; not installed.

#include <fmt/format.h>

#include <chrono>
#include <list>
#include <tuple>

#include "oca/diagrams/live/http_claims.h"
#include "oca/diagrams/live/live_client.h"

namespace oca::live {

/// One TCP connection until it is answered, or becomes a Client.
class LiveServer::Server::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Server& server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    ++server_.sockets_;
    place_ = server_.waiting_.insert(server_.waiting_.end(), this);
  }
  ~Connection() {
    --server_.sockets_;
    server_.waiting_.erase(place_);
  }

  void Start() {
    stream_.expires_after(kHttpTimeout);
    parser_.body_limit(kLargestRequest);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](const Error& error, std::size_t) {
                       if (!error) self->Answer();
                     });
  }

  /// Ends it, in favour of another.
  void Drop() {
    Error ignored;
    stream_.socket().close(ignored);
  }
  bool open() const { return stream_.socket().is_open(); }

 private:
  void Answer() {
    const auto& request = parser_.get();
    if (const auto refusal = server_.access_->Judge(internal::ClaimsOf(request, Reached()))) {
      server_.Forbid(refusal->why);
      refusal_ = fmt::format("Refused: {}.\n", refusal->why);
      return Reply(static_cast<http::status>(refusal->status), "text/plain", refusal_);
    }
    if (websocket::is_upgrade(request)) {
      stream_.expires_never();
      std::make_shared<Client>(server_, stream_.release_socket())->Start(request);
      return;
    }
    const std::string_view target(request.target().data(), request.target().size());
    const std::string_view path = target.substr(0, target.find('?'));
    const bool reads = request.method() == http::verb::get || request.method() == http::verb::head;
    if (!reads) {
      Reply(http::status::method_not_allowed, "text/plain", kOnlyGet);
    } else if (path == "/" || path == "/index.html") {
      Reply(http::status::ok, "text/html; charset=utf-8", server_.options_.page);
    } else if (path == "/record.mcap" && !server_.options_.record.empty()) {
      Reply(http::status::ok, "application/octet-stream", server_.options_.record);
    } else {
      Reply(http::status::not_found, "text/plain", kNothingHere);
    }
  }

  /// The address of this machine that it came in by.
  std::string Reached() const {
    Error ignored;
    return stream_.socket().local_endpoint(ignored).address().to_string();
  }

  /// `body` must outlive the connection.
  void Reply(http::status status, const char* type, const std::string& body) {
    response_.emplace(std::piecewise_construct, std::make_tuple(body.data(), body.size()),
                      std::make_tuple(status, parser_.get().version()));
    response_->set(http::field::content_type, type);
    response_->set(http::field::cache_control, "no-store");
    response_->set("X-Content-Type-Options", "nosniff");
    // No other page shows this one within itself, reads from it, or learns its token.
    response_->set("Content-Security-Policy", "frame-ancestors 'none'");
    response_->set("X-Frame-Options", "DENY");
    response_->set("Cross-Origin-Resource-Policy", "same-origin");
    response_->set("Referrer-Policy", "no-referrer");
    response_->keep_alive(false);
    response_->prepare_payload();
    const auto done = [self = shared_from_this()](const Error&, std::size_t) {
      Error ignored;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    };
    stream_.expires_after(6 * kHttpTimeout);
    if (parser_.get().method() == http::verb::head) {
      header_only_.emplace(*response_);
      return http::async_write_header(stream_, *header_only_, done);
    }
    http::async_write(stream_, *response_, done);
  }

  using Body = http::span_body<const char>;
  inline static const std::string kOnlyGet = "Only GET is served here.\n";
  inline static const std::string kNothingHere = "Nothing here; the page is at /.\n";

  Server& server_;
  std::list<Connection*>::iterator place_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kLargestRequest};
  http::request_parser<http::string_body> parser_;
  std::string refusal_;
  std::optional<http::response<Body>> response_;
  std::optional<http::response_serializer<Body>> header_only_;
};

}  // namespace oca::live
