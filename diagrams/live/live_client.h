// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// For LiveServer's own source file; not installed.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "oca/diagrams/live/live_server_state.h"
#include "oca/framework/dataflow/error.h"

namespace oca::live {

inline constexpr std::size_t kLargestAnswers =
    256 * 1024;  // bytes of answers that wait for one client
inline constexpr auto kTellAgainAfter = std::chrono::seconds(1);

/// One WebSocket client: what it subscribed to and what waits for it.
class LiveServer::Server::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Server& server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {}

  void Start(const http::request<http::string_body>& request) {
    auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.idle_timeout = std::chrono::seconds(60);
    stream_.set_option(timeout);
    stream_.read_message_max(kLargestRequest);
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, kProtocol);
    }));
    stream_.async_accept(request, [self = shared_from_this()](const Error& error) {
      if (!error) self->Greet();
    });
  }

  void Send(std::string text) {
    if (text_bytes_ + text.size() > kLargestAnswers + greeting_bytes_) return Close();
    text_bytes_ += text.size();
    Frame frame;
    frame.text = std::move(text);
    Push(std::move(frame));
  }

  void Send(const SharedMessage& message) {
    const auto subscription = subscriptions_.find(message->channel);
    if (subscription == subscriptions_.end()) return;
    if (queued_bytes_ + message->json.size() > server_.options_.queue_bytes) {
      ++dropped_;
      ++server_.dropped_;
      return;
    }
    Frame frame;
    frame.message = message;
    frame.header = MakeHeader(subscription->second, message->time);
    Push(std::move(frame));
    ++server_.sent_;
  }

  void Close() {
    if (closed_) return;
    closed_ = true;
    if (server_.clients_.erase(shared_from_this()) > 0) --server_.client_count_;
    Error ignored;
    stream_.next_layer().socket().close(ignored);
    queue_.clear();
  }

  void Forget() { subscriptions_.clear(); }
  bool watches() const { return watches_; }
  bool idle() const { return !writing_ && queue_.empty(); }

 private:
  void Greet() {
    server_.clients_.insert(shared_from_this());
    ++server_.client_count_;
    const std::string info = ServerInfo(server_.about_, server_.Session()),
                      channels = Advertisement(server_.channels_);
    greeting_bytes_ = info.size() + channels.size();
    Send(info);
    Send(channels);
    Read();
  }

  void Read() {
    stream_.async_read(buffer_, [self = shared_from_this()](const Error& error, std::size_t) {
      if (error) return self->Close();
      self->Handle(beast::buffers_to_string(self->buffer_.data()), self->stream_.got_text());
      self->buffer_.consume(self->buffer_.size());
      if (!self->closed_) self->Read();
    });
  }

  void Handle(const std::string& text, bool is_text) {
    try {
      if (!is_text) throw ConfigError("binary messages are not expected");
      const auto json = ordered_json::parse(text);
      const std::string op = json.at("op").get<std::string>();
      if (op == "subscribe") {
        for (const auto& item : json.at("subscriptions")) Subscribe(item);
      } else if (op == "unsubscribe") {
        for (const auto& id : json.at("subscriptionIds")) {
          std::erase_if(subscriptions_, [number = id.get<std::uint32_t>()](const auto& one) {
            return one.second == number;
          });
        }
      } else if (op == "getParameters") {
        AnswerParameters(json);
      } else if (op == "setParameters") {
        ChangeParameters(json);
      } else if (op == "subscribeParameterUpdates" || op == "unsubscribeParameterUpdates") {
        watches_ = op == "subscribeParameterUpdates";
      } else {
        throw ConfigError("unknown op");
      }
    } catch (const std::exception& error) {
      ++server_.malformed_;
      Tell(StatusLevel::kError, fmt::format("not understood: {:.200}", error.what()));
    }
  }

  void Subscribe(const ordered_json& item) {
    const auto id = item.at("id").get<std::uint32_t>();
    const int channel = item.at("channelId").get<int>();
    if (channel < 0 || static_cast<std::size_t>(channel) >= server_.channels_.size()) {
      throw ConfigError("no such channel");
    }
    const bool fresh = subscriptions_.insert_or_assign(channel, id).second;
    if (!fresh) return;
    for (const SharedMessage& message : server_.kept_) {
      if (message->channel == channel) Send(message);
    }
  }

  void AnswerParameters(const ordered_json& json) {
    const auto names = json.value("parameterNames", std::vector<std::string>{});
    std::vector<LiveParameter> asked;
    for (LiveParameter& parameter : server_.Parameters()) {
      if (names.empty() || std::find(names.begin(), names.end(), parameter.name) != names.end()) {
        asked.push_back(std::move(parameter));
      }
    }
    Send(ParameterValues(asked, json.value("id", ordered_json())));
  }

  /// Says what cannot be done; the answer has the values that count either way.
  void ChangeParameters(const ordered_json& json) {
    for (const auto& item : json.at("parameters")) {
      try {
        server_.Change(item.at("name").get<std::string>(), item.at("value"));
      } catch (const std::exception& error) {
        ++server_.malformed_;
        Tell(StatusLevel::kError, fmt::format("change refused: {:.200}", error.what()));
      }
    }
    AnswerChange(json);
  }

  /// All that watch see the change, and the one that set it if it asked for an answer.
  void AnswerChange(const ordered_json& json) {
    const std::string values = ParameterValues(server_.Parameters(), {});
    const auto clients = server_.clients_;  // one that is closed leaves the set
    for (const auto& client : clients) {
      if (client->watches_ && client.get() != this) client->Send(values);
    }
    if (json.contains("id")) Send(ParameterValues(server_.Parameters(), json["id"]));
  }

  void Tell(StatusLevel level, const std::string& text) { Send(StatusText(level, text)); }

  void Push(Frame frame) {
    if (closed_) return;
    queued_bytes_ += frame.size();
    queue_.push_back(std::move(frame));
    if (!writing_) WriteNext();
  }

  void WriteNext() {
    if (queue_.empty() || closed_) return;
    writing_ = true;
    current_ = std::move(queue_.front());
    queue_.pop_front();
    const auto done = [self = shared_from_this()](const Error& error, std::size_t) {
      self->queued_bytes_ -= self->current_.size();
      if (!self->current_.message) self->text_bytes_ -= self->current_.text.size();
      if (error) return self->Close();
      self->ConfessDrops();
      self->writing_ = false;
      self->WriteNext();
    };
    stream_.binary(current_.message != nullptr);
    if (current_.message) {
      stream_.async_write(std::array<asio::const_buffer, 2>{asio::buffer(current_.header),
                                                            asio::buffer(current_.message->json)},
                          done);
    } else {
      stream_.async_write(asio::buffer(current_.text), done);
    }
  }

  void ConfessDrops() {
    const auto now = std::chrono::steady_clock::now();
    if (dropped_ == confessed_ || now - last_confession_ < kTellAgainAfter) return;
    last_confession_ = now;
    confessed_ = dropped_;
    Tell(StatusLevel::kWarning,
         fmt::format("this client is too slow: {} messages were left out", dropped_));
  }

  Server& server_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_;
  std::map<int, std::uint32_t> subscriptions_;  ///< by channel
  std::deque<Frame> queue_;
  Frame current_;
  std::size_t queued_bytes_{0}, text_bytes_{0}, greeting_bytes_{0};
  std::uint64_t dropped_{0}, confessed_{0};
  std::chrono::steady_clock::time_point last_confession_{};
  bool writing_{false}, closed_{false}, watches_{false};
};

}  // namespace oca::live
