// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/live_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <future>

#include "oca/diagrams/live/live_connection.h"
#include "oca/framework/dataflow/error.h"

namespace oca::live {
namespace {

constexpr std::size_t kKept = 1000;   // messages for clients that come later
constexpr int kPostsInFlight = 1000;  // messages between the threads
constexpr std::size_t kBytesInFlight = std::size_t{32} << 20;
constexpr auto kAcceptAgainAfter = std::chrono::milliseconds(100);
constexpr auto kLookAgainAfter = std::chrono::milliseconds(20);  // for room
constexpr auto kDrainFor = std::chrono::milliseconds(300);
constexpr std::size_t kReasonsTold = 10;  // why requests were refused

}  // namespace

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
  thread_ = std::jthread([this] { Serve(); });
}

LiveServer::Server::~Server() {
  Drain();
  io_.stop();
  thread_.join();
  clients_.clear();
}

/// What a handler throws ends the connection that it served, and nothing else.
void LiveServer::Server::Serve() {
  while (true) {
    try {
      io_.run();
      return;
    } catch (...) {
      ++faults_;
    }
  }
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

/// Whoever has not asked for anything, or not ended to ask, goes first; then clients that never
/// said anything; then those that do not read: none of them keeps others out.
bool LiveServer::Server::MakeRoom() {
  for (Connection* const waiting : waiting_) {
    if (!waiting->open()) continue;
    waiting->Drop();
    TellCrowd(gave_way_, "a connection that asked for nothing gave way to a new one");
    return true;
  }
  const auto silent = Silent();
  if (!silent) return false;
  TellCrowd(gave_way_, silent->heard() ? "a client that did not read gave way to a new one"
                                       : "a client that never said anything gave way to a new one");
  silent->Close();
  return true;
}

/// The client that goes first; none if all are in use.
std::shared_ptr<LiveServer::Server::Client> LiveServer::Server::Silent() const {
  std::shared_ptr<Client> first;
  const auto now = std::chrono::steady_clock::now();
  for (const auto& client : clients_) {
    if (client->heard() && !(client->Owes(now) >= options_.patience)) continue;
    const auto before = [now](const Client& one, const Client& other) {
      if (one.heard() != other.heard()) return other.heard();
      if (!one.heard()) return one.number() < other.number();
      return one.Owes(now) > other.Owes(now);
    };
    if (!first || before(*client, *first)) first = client;
  }
  return first;
}

void LiveServer::Server::TellCrowd(std::atomic<std::uint64_t>& count, const std::string& what) {
  ++count;
  if (crowd_.insert(what).second && options_.crowded) options_.crowded(what);
}

void LiveServer::Server::Admit(tcp::socket socket) {
  Error ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  std::make_shared<Connection>(*this, std::move(socket))->Start();
}

/// Whoever waits gets the first place that somebody leaves, or none if all answer.
void LiveServer::Server::Hold() {
  const bool room = sockets_ < options_.max_clients || MakeRoom();
  const bool waits = !room && std::any_of(clients_.begin(), clients_.end(), [](const auto& client) {
    return client->Owes(std::chrono::steady_clock::now()).count() > 0;
  });
  if (waits) {
    pause_.expires_after(kLookAgainAfter);
    pause_.async_wait([this](const Error& stopped) {
      if (!stopped) Hold();
    });
    return;
  }
  tcp::socket socket = std::move(*held_);
  held_.reset();
  if (room) {
    Admit(std::move(socket));
  } else {
    TellCrowd(refused_, "a new connection was refused: as many as there may be are in use");
  }
  Accept();
}

void LiveServer::Server::Accept() {
  acceptor_.async_accept([this](const Error& error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (!error) {
      held_ = std::move(socket);
      if (sockets_ >= options_.max_clients) {
        for (const auto& client : std::set(clients_)) client->Ask();
      }
      return Hold();
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

void LiveServer::Server::Write(int channel, const record::RecordSample& sample) {
  if (client_count_ == 0 && !keep_[static_cast<std::size_t>(channel)]) return;
  const std::string_view json = sample.json();
  if (posts_ >= kPostsInFlight || posted_bytes_ + json.size() > kBytesInFlight) {
    ++dropped_;
    return;
  }
  ++posts_;
  posted_bytes_ += json.size();
  auto message =
      std::make_shared<const Message>(Message{channel, sample.time(), std::string(json)});
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

void LiveServer::Server::AddMetadata(const record::Metadata& metadata) {
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
  if (found == parameters_.end()) throw ConfigError("no such parameter: " + name);
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
  return {client_count_, sent_, dropped_, refused_, gave_way_, forbidden_, malformed_, faults_};
}

LiveServer::LiveServer(LiveOptions options)
    : server_(std::make_unique<Server>(std::move(options))) {}
LiveServer::~LiveServer() = default;
int LiveServer::port() const { return server_->port(); }
std::string LiveServer::url() const { return server_->url(); }
void LiveServer::Begin(const std::vector<record::RecordChannel>& channels) {
  server_->Begin(channels);
}
void LiveServer::Write(int channel, const record::RecordSample& sample) {
  server_->Write(channel, sample);
}
void LiveServer::AddMetadata(const record::Metadata& metadata) { server_->AddMetadata(metadata); }
void LiveServer::ShowMetadata() { server_->ShowMetadata(); }
void LiveServer::SetParameters(std::vector<LiveParameter> parameters) {
  server_->SetParameters(std::move(parameters));
}
void LiveServer::Tell(StatusLevel level, const std::string& text) { server_->Tell(level, text); }
std::vector<LiveParameter> LiveServer::TakeChanges() { return server_->TakeChanges(); }
LiveStatistics LiveServer::statistics() const { return server_->statistics(); }

}  // namespace oca::live
