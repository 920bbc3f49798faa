// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The inside of LiveServer, for its own source file; not installed.

#include <fmt/format.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdint>
#include <deque>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "oca/diagrams/live/access.h"
#include "oca/diagrams/live/live_server.h"
#include "oca/diagrams/live/ws_protocol.h"

namespace oca::live {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using nlohmann::ordered_json;
using Error = beast::error_code;

inline constexpr std::size_t kLargestRequest = 64 * 1024;  // bytes of a client's message

/// A message on its way to whoever subscribed to its channel.
struct Message {
  int channel;
  std::uint64_t time;
  std::string json;
};
using SharedMessage = std::shared_ptr<const Message>;

/// What waits for one client: a header of its own, and text or a message that clients share.
struct Frame {
  MessageHeader header{};
  std::string text;
  SharedMessage message;
  std::size_t size() const { return message ? header.size() + message->json.size() : text.size(); }
};

class LiveServer::Server {
 public:
  explicit Server(LiveOptions options);
  ~Server();

  int port() const { return acceptor_.local_endpoint().port(); }
  std::string url() const;
  void Begin(const std::vector<record::RecordChannel>& channels);
  void Write(int channel, const record::RecordSample& sample);
  void AddMetadata(const record::Metadata& metadata);
  void ShowMetadata();
  void SetParameters(std::vector<LiveParameter> parameters);
  void Tell(StatusLevel level, const std::string& text);
  std::vector<LiveParameter> TakeChanges();
  LiveStatistics statistics() const;

 private:
  class Connection;
  class Client;

  // On the server's own thread.
  void Drain();
  void Accept();
  void Admit(tcp::socket socket);
  void Hold();
  bool MakeRoom();
  std::shared_ptr<Client> Silent() const;
  void TellCrowd(std::atomic<std::uint64_t>& count, const std::string& what);
  void Serve();
  void Publish(const SharedMessage& message);
  void ToAll(const std::string& text);
  void TellAbout();
  std::vector<LiveParameter> Parameters() const;
  void Change(const std::string& name, const ordered_json& value);
  void Forbid(const std::string& why);
  std::string Session() const { return fmt::format("{}-{}", run_, session_); }

  const LiveOptions options_;
  const std::string run_{RandomToken()};
  const std::string token_;  ///< empty: none is needed
  std::optional<Access> access_;
  std::set<std::string> told_;      ///< why requests were refused
  std::set<std::string> crowd_;     ///< what was told of who gave way
  int sockets_{0};                  // outlives, as the next, the handlers that io_ holds
  std::list<Connection*> waiting_;  ///< those that are no clients yet, the oldest first
  asio::io_context io_;
  tcp::acceptor acceptor_{io_};
  asio::steady_timer pause_{io_};
  std::optional<tcp::socket> held_;  ///< of who waits for room; no other is accepted meanwhile
  std::set<std::shared_ptr<Client>> clients_;
  std::vector<record::RecordChannel> channels_;
  std::deque<SharedMessage> kept_;
  std::map<std::string, std::string> about_, told_about_;
  int session_{0};
  std::uint64_t greeted_{0};

  std::atomic<int> posts_{0};
  std::atomic<std::size_t> posted_bytes_{0};
  std::atomic<int> client_count_{0};
  std::atomic<std::uint64_t> sent_{0}, dropped_{0}, refused_{0}, gave_way_{0}, forbidden_{0},
      malformed_{0}, faults_{0};
  std::vector<char> keep_;  ///< by channel; of the writing thread
  mutable std::mutex mutex_;
  std::vector<LiveParameter> parameters_, changes_;  ///< under mutex_
  std::atomic<bool> changed_{false};
  std::jthread thread_;
};

}  // namespace oca::live
