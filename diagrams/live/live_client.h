// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// For LiveServer's own source file; not installed.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "oca/diagrams/live/client_request.h"
#include "oca/diagrams/live/live_server_state.h"
#include "oca/framework/dataflow/error.h"

namespace oca::live {

inline constexpr std::size_t kLargestAnswers =
    256 * 1024;  // bytes of answers that wait for one client
inline constexpr auto kTellAgainAfter = std::chrono::seconds(1);
inline constexpr auto kHttpTimeout = std::chrono::seconds(10);

/// One WebSocket client: what it subscribed to and what waits for it.
class LiveServer::Server::Client : public std::enable_shared_from_this<Client> {
 public:
  Client(Server& server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    ++server_.sockets_;
  }
  ~Client() { --server_.sockets_; }

  void Start(const http::request<http::string_body>& request) {
    auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.handshake_timeout = kHttpTimeout;
    timeout.idle_timeout = std::chrono::seconds(60);  // pings are answered within, or it is gone
    stream_.set_option(timeout);
    stream_.read_message_max(kLargestRequest);
    stream_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, kProtocol);
    }));
    stream_.control_callback([this](websocket::frame_type type, beast::string_view payload) {
      if (type == websocket::frame_type::pong && payload == question_) asked_.reset();
    });
    stream_.async_accept(request, [self = shared_from_this()](const Error& error) {
      if (!error) self->Guarded([&self] { self->Greet(); });
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

  /// Pings it, unless it has one to answer.
  void Ask() {
    if (asked_ || closed_) return;
    asked_ = std::chrono::steady_clock::now();
    question_ = RandomToken();  // so that nobody answers who has not read it
    stream_.async_ping(websocket::ping_data(question_.c_str()),
                       [self = shared_from_this()](const Error& error) {
                         if (error) self->Close();
                       });
  }
  /// How long it has not answered; 0: it has.
  std::chrono::steady_clock::duration Owes(std::chrono::steady_clock::time_point now) const {
    return asked_ ? std::max(now - *asked_, std::chrono::steady_clock::duration(1))
                  : std::chrono::steady_clock::duration(0);
  }

  void Forget() { subscriptions_.clear(); }
  bool watches() const { return watches_; }
  /// Whether it ever said anything.
  bool heard() const { return heard_; }
  /// The number of its connection.
  std::uint64_t number() const { return number_; }
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
      self->Guarded([&self] {
        self->heard_ = true;
        self->Handle(beast::buffers_to_string(self->buffer_.data()), self->stream_.got_text());
        self->buffer_.consume(self->buffer_.size());
        if (!self->closed_) self->Read();
      });
    });
  }

  /// Whatever goes wrong ends this connection and nothing else.
  template <class Work>
  void Guarded(const Work& work) {
    try {
      work();
    } catch (const std::exception&) {
      ++server_.faults_;
      Close();
    }
  }

  void Handle(const std::string& text, bool is_text) {
    using Kind = internal::ClientRequest::Kind;
    try {
      if (!is_text) throw ConfigError("binary messages are not expected");
      const auto request = internal::ReadRequest(text, server_.channels_.size());
      switch (request.kind) {
        case Kind::kSubscribe:
          return Subscribe(request);
        case Kind::kUnsubscribe:
          std::erase_if(subscriptions_, [&request](const auto& one) {
            return std::find(request.ids.begin(), request.ids.end(), one.second) !=
                   request.ids.end();
          });
          return;
        case Kind::kGetParameters:
          return AnswerParameters(request);
        case Kind::kSetParameters:
          return ChangeParameters(request);
        default:
          watches_ = request.kind == Kind::kWatchParameters;
      }
    } catch (const ConfigError& error) {
      ++server_.malformed_;
      Tell(StatusLevel::kError, fmt::format("not understood: {:.200}", error.what()));
    }
  }

  /// A channel has one subscription of a client, an id stands for one.
  void Subscribe(const internal::ClientRequest& request) {
    for (const auto& [id, channel] : request.subscriptions) {
      for (const auto& [taken_by, taken] : subscriptions_) {
        if (taken != id || taken_by == channel) continue;
        throw ConfigError(fmt::format("id: got {}, that of a subscription; expected another", id));
      }
    }
    for (const auto& one : request.subscriptions) {
      if (!subscriptions_.insert_or_assign(one.channel, one.id).second) continue;
      for (const SharedMessage& message : server_.kept_) {
        if (message->channel == one.channel) Send(message);
      }
    }
  }

  void AnswerParameters(const internal::ClientRequest& request) {
    const auto& names = request.names;
    std::vector<LiveParameter> asked;
    for (LiveParameter& parameter : server_.Parameters()) {
      if (names.empty() || std::find(names.begin(), names.end(), parameter.name) != names.end()) {
        asked.push_back(std::move(parameter));
      }
    }
    Send(ParameterValues(asked, request.id));
  }

  /// Says what cannot be done; the answer has the values that count either way.
  void ChangeParameters(const internal::ClientRequest& request) {
    for (const auto& [name, value] : request.values) {
      try {
        server_.Change(name, value);
      } catch (const ConfigError& error) {
        ++server_.malformed_;
        Tell(StatusLevel::kError, fmt::format("change refused: {:.200}", error.what()));
      }
    }
    AnswerChange(request);
  }

  /// All that watch see the change, and the one that set it if it asked for an answer.
  void AnswerChange(const internal::ClientRequest& request) {
    const std::string values = ParameterValues(server_.Parameters(), {});
    const auto clients = server_.clients_;  // one that is closed leaves the set
    for (const auto& client : clients) {
      if (client->watches_ && client.get() != this) client->Send(values);
    }
    if (!request.id.is_null()) Send(ParameterValues(server_.Parameters(), request.id));
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
      self->Guarded([&self] {
        self->ConfessDrops();
        self->writing_ = false;
        self->WriteNext();
      });
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
  std::optional<std::chrono::steady_clock::time_point> asked_;  ///< since when a ping is open
  std::string question_;                                        ///< the payload of the last ping
  bool writing_{false}, closed_{false}, watches_{false}, heard_{false};
  const std::uint64_t number_{++server_.greeted_};
};

}  // namespace oca::live
