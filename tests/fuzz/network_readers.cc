// SPDX-License-Identifier: BSD-3-Clause
// What a live run is told over a socket.
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/beast/_experimental/test/stream.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "oca/diagrams/live/access.h"
#include "oca/diagrams/live/client_request.h"
#include "oca/diagrams/live/http_claims.h"
#include "oca/diagrams/live/ws_protocol.h"
#include "tests/fuzz/foreign_bytes.h"

namespace oca::test {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

constexpr int kPort = 8765;
constexpr std::size_t kLargest = 64 * 1024;

bool ReadMessage(std::string_view text) {
  return Accepts([&] {
    const auto request = live::internal::ReadRequest(text, 3);
    for (const auto& [name, value] : request.values) {
      Accepts([&json = value] { live::ReadValue(json, 1.0); });
      Accepts([&json = value] { live::ReadValue(json, std::vector<double>{1.0, 2.0, 3.0}); });
    }
    live::ParameterValues({{"gain", 1.0}}, request.id);
  });
}

/// A request, and whether it may be answered.
bool ReadHttp(std::string_view bytes) {
  static const live::Access access({"127.0.0.1", kPort, {"foxglove", "https://a.example"}, "ab"});
  http::request_parser<http::string_body> parser;
  parser.body_limit(kLargest);
  parser.eager(true);
  beast::error_code error;
  parser.put(asio::buffer(bytes.data(), bytes.size()), error);
  if (error || !parser.is_done()) return false;
  return !access.Judge(live::internal::ClaimsOf(parser.get(), "127.0.0.1")).has_value();
}

/// What comes behind the handshake: frames, and the messages that they make up.
bool ReadFrames(std::string_view bytes) {
  asio::io_context io;
  beast::test::stream socket(io);
  beast::test::stream other = beast::test::connect(socket);
  websocket::stream<beast::test::stream> stream(std::move(socket));
  stream.read_message_max(kLargest);
  http::request<http::empty_body> upgrade(http::verb::get, "/", 11);
  upgrade.set(http::field::host, "localhost");
  upgrade.set(http::field::connection, "Upgrade");
  upgrade.set(http::field::upgrade, "websocket");
  upgrade.set(http::field::sec_websocket_version, "13");
  upgrade.set(http::field::sec_websocket_key, "AAAAAAAAAAAAAAAAAAAAAA==");
  beast::error_code error;
  stream.accept(upgrade, error);
  if (error) return false;
  stream.next_layer().append(beast::string_view(bytes.data(), bytes.size()));
  other.close();
  bool accepted = false;
  while (true) {
    beast::flat_buffer buffer;
    stream.read(buffer, error);
    if (error) return accepted;
    accepted |= ReadMessage(beast::buffers_to_string(buffer.data()));
  }
}

}  // namespace

std::vector<Reader> NetworkReaders() {
  using enum Reader::Kind;
  return {
      {"frames", kBinary, ReadFrames}, {"http", kText, ReadHttp}, {"message", kText, ReadMessage}};
}

}  // namespace oca::test
