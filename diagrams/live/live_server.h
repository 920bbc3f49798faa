// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "oca/diagrams/record/record_sink.h"

namespace oca::live {

/// A value that a user may change while the run goes on.
struct LiveParameter {
  using Value = std::variant<bool, double, std::string, std::vector<double>>;
  std::string name{};
  Value value{};
};

struct LiveOptions {
  std::string address{"127.0.0.1"};  ///< to listen on; the loopback, unless somebody asks
  int port{8765};                    ///< 0: any that is free
  std::string page{};                ///< HTML, served at `/`
  std::string record{};              ///< MCAP, served at `/record.mcap` unless empty
  std::size_t queue_bytes{std::size_t{4} << 20};  ///< of messages that wait for one client
  int max_clients{64};  ///< connections at a time; one that is silent goes for a new one
  std::chrono::milliseconds patience{
      2000};                           ///< with clients that answer no ping, while others wait
  std::vector<std::string> origins{};  ///< of other pages that may connect, see Access
  /// Told why a request was refused, each reason once and some only; on the server's own thread.
  std::function<void(const std::string& why)> forbidden{};
  /// Told of connections that gave way or were kept out, each kind once; on the same thread.
  std::function<void(const std::string& what)> crowded{};
};

enum class StatusLevel { kInfo = 0, kWarning = 1, kError = 2 };

struct LiveStatistics {
  int clients{0};              ///< WebSocket clients now
  std::uint64_t sent{0};       ///< messages to all clients
  std::uint64_t dropped{0};    ///< messages that a slow client, or all of them, did not get
  std::uint64_t refused{0};    ///< connections beyond max_clients, all of them in use
  std::uint64_t gave_way{0};   ///< connections that ended in favour of new ones
  std::uint64_t forbidden{0};  ///< requests that Access refused
  std::uint64_t malformed{0};  ///< client messages that made no sense
  std::uint64_t faults{0};     ///< connections that ended since something went wrong here
};

/// Shows a run while it goes on: the page over HTTP and the messages over foxglove.websocket.v1, on
/// one port, from a thread of its own.
///
/// Write never waits: what a slow client cannot take is dropped, counted, and told to it. Messages
/// on /scene/robots and /scene/obstacles are kept for clients that come later.
///
/// At most max_clients connections are open. A new one takes the place of the oldest that has not
/// asked for anything within 10 s at most, else of the oldest client that never said anything, else
/// of the one that has owed the answer to a ping longest, if for `patience`: that does not read.
/// It waits until all have been asked that long, and is refused if all answered. An exception on
/// the server's thread ends the connection that it is about.
///
/// Access decides who is answered. On an address that others reach, a request needs the token that
/// stands in url(). Its session is one that no other server has, so that clients see a new run.
/// source https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md, version 1
class LiveServer final : public record::RecordSink {
 public:
  /// throws ConfigError if the address or the port is bad or taken, or an origin is none.
  explicit LiveServer(LiveOptions options);
  ~LiveServer() override;
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  int port() const;
  /// For a browser, with the token if there is one.
  std::string url() const;

  /// A second Begin with the same channels goes on with the same session.
  void Begin(const std::vector<record::RecordChannel>& channels) override;
  void Write(int channel, const record::RecordSample& sample) override;
  void AddMetadata(const record::Metadata& metadata) override;
  /// Shows what AddMetadata added to the clients of now, as Begin does. Any thread.
  void ShowMetadata();

  /// What clients see of the parameters from now on; only these names can be set. Any thread.
  void SetParameters(std::vector<LiveParameter> parameters);
  /// Shows a line to all clients. Any thread.
  void Tell(StatusLevel level, const std::string& text);
  /// What clients set since the last call, the last value of each name. Does not wait for the
  /// network. Any thread.
  std::vector<LiveParameter> TakeChanges();
  /// Any thread.
  LiveStatistics statistics() const;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace oca::live
