// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/socket.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace oca::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using nlohmann::json;

inline tcp::socket Connect(asio::io_context& io, int port) {
  tcp::socket socket(io);
  socket.connect({asio::ip::make_address("127.0.0.1"), static_cast<std::uint16_t>(port)});
  return socket;
}

/// A client of foxglove.websocket.v1 that waits for what it reads.
class Client {
 public:
  explicit Client(int port) : stream_(io_) {
    stream_.next_layer() = Connect(io_, port);
    stream_.set_option(websocket::stream_base::decorator([](websocket::request_type& request) {
      request.set(http::field::sec_websocket_protocol, "foxglove.websocket.v1");
    }));
    stream_.handshake(response_, "localhost", "/");
  }
  std::string Protocol() const {
    return std::string(response_[http::field::sec_websocket_protocol]);
  }
  std::string Read() {
    beast::flat_buffer buffer;
    stream_.read(buffer);
    return beast::buffers_to_string(buffer.data());
  }
  json ReadJson() { return json::parse(Read()); }
  /// Skips what is no answer of a kind.
  json ReadOp(const std::string& op) {
    for (;;) {
      const std::string text = Read();
      if (!stream_.got_text()) continue;
      json answer = json::parse(text);
      if (answer["op"] == op) return answer;
    }
  }
  void Send(const std::string& text) {
    stream_.text(true);
    stream_.write(asio::buffer(text));
  }
  void SendBinary(const std::string& bytes) {
    stream_.binary(true);
    stream_.write(asio::buffer(bytes));
  }
  void Subscribe(int channel, std::uint32_t id) {
    Send(json{{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}}
             .dump());
  }
  /// Returns once the server has taken what was sent before.
  void Settle() {
    Send(R"({"op": "getParameters", "parameterNames": [], "id": "settle"})");
    while (ReadOp("parameterValues").value("id", "") != "settle") {
    }
  }
  /// Ends the connection under whoever reads from it on another thread.
  void Drop() { ::shutdown(stream_.next_layer().native_handle(), SHUT_RDWR); }
  void Close() { stream_.close(websocket::close_code::normal); }

 private:
  asio::io_context io_;
  websocket::stream<tcp::socket> stream_;
  websocket::response_type response_;
};

}  // namespace oca::live
