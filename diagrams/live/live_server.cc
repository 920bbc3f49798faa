// SPDX-License-Identifier: BSD-3-Clause
// The one file that knows Boost; longer than others for that reason.
#include "diagrams/live/live_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <future>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "diagrams/live/access.h"
#include "diagrams/live/ws_protocol.h"
#include "framework/error.h"

namespace oca::live {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using nlohmann::ordered_json;
using Error = beast::error_code;

constexpr std::size_t kLargestRequest = 64 * 1024;   // bytes of a client's message
constexpr std::size_t kLargestAnswers = 256 * 1024;  // bytes of answers that wait for one client
constexpr std::size_t kKept = 1000;                  // messages for clients that come later
constexpr int kPostsInFlight = 1000;                 // messages between the threads
constexpr std::size_t kBytesInFlight = std::size_t{32} << 20;
constexpr auto kHttpTimeout = std::chrono::seconds(10);
constexpr auto kAcceptAgainAfter = std::chrono::milliseconds(100);
constexpr auto kTellAgainAfter = std::chrono::seconds(1);
constexpr auto kDrainFor = std::chrono::milliseconds(300);
constexpr std::size_t kReasonsTold = 10;  // why requests were refused

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

}  // namespace

class LiveServer::Server {
 public:
  explicit Server(LiveOptions options);
  ~Server();

  int port() const { return acceptor_.local_endpoint().port(); }
  std::string url() const;
  void Begin(const std::vector<record::RecordChannel>& channels);
  void Write(int channel, std::uint64_t time, std::string_view json);
  void AddMetadata(const record::McapMetadata& metadata);
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
  std::set<std::string> told_;  ///< why requests were refused
  int connections_{0};          // outlives the handlers that io_ holds
  asio::io_context io_;
  tcp::acceptor acceptor_{io_};
  asio::steady_timer pause_{io_};
  std::set<std::shared_ptr<Client>> clients_;
  std::vector<record::RecordChannel> channels_;
  std::deque<SharedMessage> kept_;
  std::map<std::string, std::string> about_, told_about_;
  int session_{0};

  std::atomic<int> posts_{0};
  std::atomic<std::size_t> posted_bytes_{0};
  std::atomic<int> client_count_{0};
  std::atomic<std::uint64_t> sent_{0}, dropped_{0}, refused_{0}, forbidden_{0}, malformed_{0};
  std::vector<char> keep_;  ///< by channel; of the writing thread
  mutable std::mutex mutex_;
  std::vector<LiveParameter> parameters_, changes_;  ///< under mutex_
  std::atomic<bool> changed_{false};
  std::jthread thread_;
};

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
      if (!is_text) throw std::invalid_argument("binary messages are not expected");
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
        throw std::invalid_argument("unknown op");
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
      throw std::invalid_argument("no such channel");
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

/// One TCP connection until it is answered, or becomes a Client.
class LiveServer::Server::Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Server& server, tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    ++server_.connections_;
  }
  ~Connection() { --server_.connections_; }

  void Start() {
    stream_.expires_after(kHttpTimeout);
    parser_.body_limit(kLargestRequest);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](const Error& error, std::size_t) {
                       if (!error) self->Answer();
                     });
  }

 private:
  void Answer() {
    const auto& request = parser_.get();
    if (const auto refusal = server_.access_->Judge(ClaimsOf(request))) {
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

  Claims ClaimsOf(const http::request<http::string_body>& request) const {
    const auto all = [&request](http::field name) {
      std::vector<std::string> values;
      const auto [begin, end] = request.equal_range(name);
      for (auto field = begin; field != end; ++field) values.emplace_back(field->value());
      return values;
    };
    Error ignored;
    const auto reached = stream_.socket().local_endpoint(ignored).address();
    return {all(http::field::host), all(http::field::origin), std::string(request.target()),
            reached.to_string()};
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
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kLargestRequest};
  http::request_parser<http::string_body> parser_;
  std::string refusal_;
  std::optional<http::response<Body>> response_;
  std::optional<http::response_serializer<Body>> header_only_;
};

LiveServer::Server::Server(LiveOptions options)
    : options_(std::move(options)), token_(IsLoopback(options_.address) ? "" : RandomToken()) {
  Error error;
  const auto address = asio::ip::make_address(options_.address, error);
  if (error) {
    throw ConfigError(fmt::format("live: address; got '{}'; expected a number such as 127.0.0.1",
                                  options_.address));
  }
  if (options_.port < 0 || options_.port > 65535) {
    throw ConfigError(fmt::format("live: port; got {}; expected 0 to 65535", options_.port));
  }
  const tcp::endpoint endpoint(address, static_cast<std::uint16_t>(options_.port));
  acceptor_.open(endpoint.protocol(), error);
  if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor_.bind(endpoint, error);
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) {
    throw ConfigError(fmt::format("live: port; got {}:{} ({}); expected one that is free",
                                  options_.address, options_.port, error.message()));
  }
  access_.emplace(AccessOptions{options_.address, port(), options_.origins, token_});
  Accept();
  thread_ = std::jthread([this] { io_.run(); });
}

LiveServer::Server::~Server() {
  Drain();
  io_.stop();
  thread_.join();
  clients_.clear();
}

/// What was said last reaches whoever reads it soon: how the run ended.
void LiveServer::Server::Drain() {
  const auto end = std::chrono::steady_clock::now() + kDrainFor;
  for (bool idle = false; !idle && std::chrono::steady_clock::now() < end;) {
    const auto answer = std::make_shared<std::promise<bool>>();
    asio::post(io_, [this, answer] {
      answer->set_value(std::all_of(clients_.begin(), clients_.end(),
                                    [](const auto& client) { return client->idle(); }));
    });
    auto future = answer->get_future();
    idle = future.wait_until(end) == std::future_status::ready && future.get();
    if (!idle) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

void LiveServer::Server::Accept() {
  acceptor_.async_accept([this](const Error& error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (!error) {
      if (connections_ + client_count_ < options_.max_clients) {
        Error ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        std::make_shared<Connection>(*this, std::move(socket))->Start();
      } else {
        ++refused_;
      }
      return Accept();
    }
    pause_.expires_after(kAcceptAgainAfter);  // no file is left, perhaps
    pause_.async_wait([this](const Error& stopped) {
      if (!stopped) Accept();
    });
  });
}

void LiveServer::Server::Begin(const std::vector<record::RecordChannel>& channels) {
  keep_.assign(channels.size(), 0);
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const std::string& topic = channels[i].topic;
    keep_[i] = topic == "/scene/robots" || topic == "/scene/obstacles" || topic == "/metrics";
  }
  asio::post(io_, [this, channels] {
    const bool same = std::equal(
        channels.begin(), channels.end(), channels_.begin(), channels_.end(),
        [](const auto& a, const auto& b) { return a.topic == b.topic && a.schema == b.schema; });
    kept_.clear();
    if (same) return ShowMetadata();
    if (!channels_.empty()) ToAll(Unadvertisement(channels_.size()));
    for (const auto& client : clients_) client->Forget();
    channels_ = channels;
    ++session_;
    TellAbout();
    ToAll(Advertisement(channels_));
  });
}

void LiveServer::Server::Write(int channel, std::uint64_t time, std::string_view json) {
  if (client_count_ == 0 && !keep_[static_cast<std::size_t>(channel)]) return;
  if (posts_ >= kPostsInFlight || posted_bytes_ + json.size() > kBytesInFlight) {
    ++dropped_;
    return;
  }
  ++posts_;
  posted_bytes_ += json.size();
  auto message = std::make_shared<const Message>(Message{channel, time, std::string(json)});
  const bool keep = keep_[static_cast<std::size_t>(channel)];
  asio::post(io_, [this, keep, message = std::move(message)] {
    --posts_;
    posted_bytes_ -= message->json.size();
    if (keep) kept_.push_back(message);
    if (kept_.size() > kKept) kept_.pop_front();
    Publish(message);
  });
}

void LiveServer::Server::Publish(const SharedMessage& message) {
  for (const auto& client : clients_) client->Send(message);
}

void LiveServer::Server::TellAbout() {
  told_about_ = about_;
  ToAll(ServerInfo(about_, Session()));
}

void LiveServer::Server::ToAll(const std::string& text) {
  const auto clients = clients_;  // one that is closed leaves the set
  for (const auto& client : clients) client->Send(text);
}

void LiveServer::Server::AddMetadata(const record::McapMetadata& metadata) {
  asio::post(io_, [this, metadata] {
    for (const auto& [key, value] : metadata.values) {
      about_[metadata.name == "oca" ? key : metadata.name + "/" + key] = value;
    }
  });
}

void LiveServer::Server::ShowMetadata() {
  asio::dispatch(io_, [this] {
    if (about_ != told_about_) TellAbout();
  });
}

std::vector<LiveParameter> LiveServer::Server::Parameters() const {
  const std::lock_guard lock(mutex_);
  return parameters_;
}

void LiveServer::Server::SetParameters(std::vector<LiveParameter> parameters) {
  const std::string values = ParameterValues(parameters, {});
  {
    const std::lock_guard lock(mutex_);
    parameters_ = std::move(parameters);
  }
  asio::post(io_, [this, values] {
    const auto clients = clients_;
    for (const auto& client : clients) {
      if (client->watches()) client->Send(values);
    }
  });
}

void LiveServer::Server::Change(const std::string& name, const ordered_json& value) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                  [&](const auto& one) { return one.name == name; });
  if (found == parameters_.end()) throw std::invalid_argument("no such parameter: " + name);
  found->value = ReadValue(value, found->value);
  std::erase_if(changes_, [&](const auto& change) { return change.name == name; });
  changes_.push_back(*found);
  changed_ = true;
}

void LiveServer::Server::Tell(StatusLevel level, const std::string& text) {
  asio::post(io_, [this, status = StatusText(level, text)] { ToAll(status); });
}

void LiveServer::Server::Forbid(const std::string& why) {
  ++forbidden_;
  if (!options_.forbidden || told_.size() >= kReasonsTold || !told_.insert(why).second) return;
  options_.forbidden(why);
}

std::string LiveServer::Server::url() const {
  const bool six = options_.address.find(':') != std::string::npos;
  return fmt::format("http://{}:{}/{}{}", six ? "[" + options_.address + "]" : options_.address,
                     port(), token_.empty() ? "" : "?token=", token_);
}

std::vector<LiveParameter> LiveServer::Server::TakeChanges() {
  if (!changed_) return {};
  const std::lock_guard lock(mutex_);
  changed_ = false;
  return std::exchange(changes_, {});
}

LiveStatistics LiveServer::Server::statistics() const {
  return {client_count_, sent_, dropped_, refused_, forbidden_, malformed_};
}

LiveServer::LiveServer(LiveOptions options)
    : server_(std::make_unique<Server>(std::move(options))) {}
LiveServer::~LiveServer() = default;
int LiveServer::port() const { return server_->port(); }
std::string LiveServer::url() const { return server_->url(); }
void LiveServer::Begin(const std::vector<record::RecordChannel>& channels) {
  server_->Begin(channels);
}
void LiveServer::Write(int channel, std::uint64_t time, std::string_view json) {
  server_->Write(channel, time, json);
}
void LiveServer::AddMetadata(const record::McapMetadata& metadata) {
  server_->AddMetadata(metadata);
}
void LiveServer::ShowMetadata() { server_->ShowMetadata(); }
void LiveServer::SetParameters(std::vector<LiveParameter> parameters) {
  server_->SetParameters(std::move(parameters));
}
void LiveServer::Tell(StatusLevel level, const std::string& text) { server_->Tell(level, text); }
std::vector<LiveParameter> LiveServer::TakeChanges() { return server_->TakeChanges(); }
LiveStatistics LiveServer::statistics() const { return server_->statistics(); }

}  // namespace oca::live
