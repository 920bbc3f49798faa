// SPDX-License-Identifier: BSD-3-Clause
// That a LiveServer outlives its clients: garbage, floods, many, and those that do not read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <chrono>
#include <deque>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "oca/diagrams/live/live_server.h"
#include "tests/diagrams/live/server_bench.h"
#include "tests/diagrams/live/ws_client.h"

namespace oca::live {
namespace live_server_clients_test {

using server_bench::AnyPort;
using server_bench::Eventually;
using server_bench::kChannels;
using testing::HasSubstr;
using testing::Not;
using namespace std::chrono_literals;

/// Reads from a client until that is dropped.
class Reading {
 public:
  explicit Reading(Client& client)
      : thread_([&client] { EXPECT_THROW(for (;;) client.Read(), boost::system::system_error); }) {}

 private:
  std::jthread thread_;
};

TEST(LiveServerClientsTest, OutlivesGarbage) {
  LiveServer server(AnyPort());
  server.Begin(kChannels);
  std::mt19937 random(1);
  for (int round = 0; round < 200; ++round) {  // raw bytes instead of HTTP
    asio::io_context io;
    tcp::socket socket = Connect(io, server.port());
    std::string bytes(1 + random() % 300, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    beast::error_code ignored;
    asio::write(socket, asio::buffer(bytes), ignored);
  }
  Client client(server.port());
  const std::string valid = R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":2}]})";
  for (int round = 0; round < 300; ++round) {
    std::string text = valid;
    for (int k = 0; k < 3; ++k)
      text[random() % text.size()] = static_cast<char>(32 + random() % 95);
    client.Send(text);
    if (round % 10 == 0) client.SendBinary("\x01\x02");
    if (round % 50 == 0) client.Settle();
  }
  client.Send(std::string(30000, '['));
  client.Settle();
  EXPECT_GT(server.statistics().malformed, 100u);
}

TEST(LiveServerClientsTest, HangsUpOnAMessageThatIsTooLarge) {
  LiveServer server(AnyPort());
  Client client(server.port());
  client.Settle();
  EXPECT_THROW(
      {
        client.Send(std::string(1 << 20, ' '));
        for (;;) client.Read();
      },
      boost::system::system_error);
  EXPECT_TRUE(Eventually([&] { return server.statistics().clients == 0; }));
}

TEST(LiveServerClientsTest, OutlivesAFloodOfQuestionsThatNobodyReadsTheAnswersOf) {
  LiveServer server(AnyPort());
  server.SetParameters({{"text", std::string(1000, 'x')}});
  Client flood(server.port());
  try {
    for (int i = 0; i < 20000; ++i) flood.Send(R"({"op": "getParameters", "parameterNames": []})");
  } catch (const boost::system::system_error&) {
    // hung up on, as it should be
  }
  Client polite(server.port());
  polite.Settle();
}

TEST(LiveServerClientsTest, OutlivesAHundredThatComeAndGo) {
  LiveServer server(AnyPort());
  server.Begin(kChannels);
  std::atomic<bool> done{false};
  std::thread writer([&] {
    for (std::uint64_t time = 0; !done; ++time) {
      server.Write(static_cast<int>(time % 3), {R"({"a1": 0.5})", time});
      std::this_thread::sleep_for(100us);
    }
  });
  for (int round = 0; round < 100; ++round) {
    Client client(server.port());
    for (int channel = 0; channel < 3; ++channel) client.Subscribe(channel, channel);
    client.Read();
    if (round % 2 == 0) client.Close();
  }
  EXPECT_TRUE(Eventually([&] { return server.statistics().clients == 0; }));
  done = true;
  writer.join();
}

TEST(LiveServerClientsTest, NeverWaitsForAClientThatStopsReading) {
  LiveOptions options = AnyPort();
  options.queue_bytes = 1 << 20;
  LiveServer server(options);
  server.Begin(kChannels);
  Client sleeper(server.port()), reader(server.port());
  sleeper.Subscribe(0, 1);
  reader.Subscribe(2, 1);
  sleeper.Settle();
  reader.Settle();
  const std::string large(100000, ' ');
  std::chrono::steady_clock::duration longest{};
  for (int i = 0; i < 500; ++i) {  // 50 MB that nobody reads
    const auto start = std::chrono::steady_clock::now();
    server.Write(0, {large, 1});
    longest = std::max(longest, std::chrono::steady_clock::now() - start);
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_LT(longest, 500ms);  // a write that waited for the sleeper would never end
  EXPECT_TRUE(Eventually([&] { return server.statistics().dropped > 300; }));
  server.Write(2, {R"({"a1": 0.5})", 1});
  EXPECT_THAT(reader.Read(), HasSubstr("a1"));
  // Awake again, it is told what it missed.
  EXPECT_THAT(sleeper.ReadOp("status")["message"].get<std::string>(), HasSubstr("left out"));
}

TEST(LiveServerClientsTest, RefusesMoreConnectionsThanItWants) {
  LiveOptions options = AnyPort();
  options.max_clients = 2;
  std::atomic<int> told{0};
  options.crowded = [&](const std::string& what) { told += what.starts_with("a new connection"); };
  LiveServer server(options);
  Client one(server.port()), two(server.port());
  one.Settle();
  two.Settle();
  const Reading reads_one(one), reads_two(two);  // and so answers pings
  EXPECT_THROW(Client(server.port()), boost::system::system_error);
  EXPECT_EQ(server.statistics().refused, 1u);
  EXPECT_EQ(server.statistics().gave_way, 0u);
  EXPECT_EQ(told, 1);
  one.Drop();
  EXPECT_TRUE(Eventually([&] { return server.statistics().clients == 1; }));
  Client three(server.port());
  three.Settle();
  two.Drop();
}

TEST(LiveServerClientsTest, ClientsThatDoNotReadGiveWayToNewOnes) {
  LiveOptions options = AnyPort();
  options.max_clients = 4;
  options.patience = 300ms;
  std::atomic<int> told{0};
  options.crowded = [&](const std::string& what) { told += what.starts_with("a client that did"); };
  LiveServer server(options);
  server.Begin(kChannels);
  Client reader(server.port());
  reader.Settle();
  const Reading reads(reader);
  std::deque<Client> silent;  // they subscribed, and neither read nor answer
  for (int i = 0; i < 3; ++i) {
    silent.emplace_back(server.port()).Subscribe(2, 1);
    silent.back().Settle();
  }
  const auto start = std::chrono::steady_clock::now();
  std::deque<Client> fresh;
  for (int i = 0; i < 3; ++i) fresh.emplace_back(server.port()).Settle();
  const auto took = std::chrono::steady_clock::now() - start;
  EXPECT_GE(took, 300ms);  // so long they may take to answer
  EXPECT_LT(took, 10s);    // not a minute
  for (Client& client : silent) {
    EXPECT_THROW(for (;;) client.Read(), boost::system::system_error);
  }
  EXPECT_EQ(server.statistics().gave_way, 3u);
  EXPECT_EQ(server.statistics().refused, 0u);
  EXPECT_EQ(told, 1);                         // once of a kind
  EXPECT_EQ(server.statistics().clients, 4);  // the one that reads among them
  reader.Drop();
}

TEST(LiveServerClientsTest, IdleSocketsKeepNobodyOut) {
  LiveOptions options = AnyPort();
  options.max_clients = 4;
  LiveServer server(options);
  asio::io_context io;
  std::vector<tcp::socket> idle;
  for (int i = 0; i < 8; ++i) {
    idle.push_back(Connect(io, server.port()));
    if (i % 2 == 0) asio::write(idle.back(), asio::buffer("GET / HTTP/1.1\r\nHo", 18));
  }
  Client client(server.port());
  client.Settle();
  for (int i = 0; i < 8; ++i) idle.push_back(Connect(io, server.port()));
  client.Settle();  // what is in use stays
  EXPECT_EQ(server.statistics().refused, 0u);
}

TEST(LiveServerClientsTest, ClientsThatNeverSayAnythingKeepNobodyOut) {
  LiveOptions options = AnyPort();
  options.max_clients = 3;
  LiveServer server(options);
  Client busy(server.port());
  busy.Settle();
  std::deque<Client> silent;
  for (int i = 0; i < 5; ++i) silent.emplace_back(server.port()).ReadOp("serverInfo");
  Client another(server.port());
  another.Settle();
  busy.Settle();
  EXPECT_THROW(for (;;) silent.front().Read(), boost::system::system_error);
  EXPECT_EQ(server.statistics().refused, 0u);
}

TEST(LiveServerClientsTest, TakesIdsThatAreOnesAndEachOnce) {
  LiveServer server(AnyPort());
  server.Begin(kChannels);
  Client client(server.port());
  client.ReadOp("advertise");
  for (const char* const bad :
       {R"({"id": -1, "channelId": 0})", R"({"id": 4294967296, "channelId": 0})",
        R"({"id": 1e30, "channelId": 0})", R"({"id": 1.5, "channelId": 0})",
        R"({"id": "1", "channelId": 0})", R"({"channelId": 0})", R"({"id": 1, "channelId": 3})",
        R"({"id": 1, "channelId": -1})", R"({"id": 1, "channelId": 4294967296})",
        R"({"id": 1, "channelId": 0.5})", R"({"id": 1, "channelId": 0}, {"id": 1, "channelId": 1})",
        "7", "null"}) {
    client.Send(std::string(R"({"op": "subscribe", "subscriptions": [)") + bad + "]}");
    const json status = client.ReadOp("status");
    EXPECT_EQ(status["level"], 2) << bad;
    EXPECT_THAT(status["message"].get<std::string>(), HasSubstr("; expected")) << bad;
  }
  client.Subscribe(0, 1);
  client.Subscribe(0, 1);
  client.Subscribe(2, 1);  // the id of the other
  EXPECT_THAT(client.ReadOp("status")["message"].get<std::string>(), HasSubstr("got 1"));
  client.Send(R"({"op": "unsubscribe", "subscriptionIds": [-1]})");
  EXPECT_EQ(client.ReadOp("status")["level"], 2);
  client.Subscribe(2, 4294967295);
  client.Settle();
  server.Write(0, {"{}", 1});
  server.Write(2, {R"({"a1": 1})", 1});
  EXPECT_THAT(client.Read(), HasSubstr("{}"));
  EXPECT_THAT(client.Read(), HasSubstr("\xFF\xFF\xFF\xFF"));
}

TEST(LiveServerClientsTest, SaysInItsOwnWordsWhatItDoesNotUnderstand) {
  LiveServer server(AnyPort());
  Client client(server.port());
  const std::string deep = std::string(30000, '[') + std::string(30000, ']');
  for (const std::string& bad :
       {std::string("{"), std::string("7"), std::string(R"({"op": 7})"),
        std::string(R"({"op": "getParameters", "parameterNames": [7]})"),
        R"({"op": "getParameters", "id": )" + deep + "}", R"({"op": "dance"})" + std::string()}) {
    client.Send(bad);
    const std::string what = client.ReadOp("status")["message"].get<std::string>();
    EXPECT_THAT(what, HasSubstr("; expected")) << bad.substr(0, 60);
    EXPECT_THAT(what, Not(HasSubstr("exception"))) << bad.substr(0, 60);
  }
}

TEST(LiveServerClientsTest, AnExceptionOnItsThreadEndsTheConnectionAlone) {
  LiveOptions options = AnyPort();
  options.forbidden = [](const std::string&) { throw std::runtime_error("not mine"); };
  LiveServer server(options);
  Client before(server.port());
  before.Settle();
  asio::io_context io;
  tcp::socket foreign = Connect(io, server.port());
  asio::write(foreign, asio::buffer(std::string("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n")));
  char byte = 0;
  beast::error_code error;
  asio::read(foreign, asio::buffer(&byte, 1), error);
  EXPECT_TRUE(error);
  before.Settle();  // the server's thread has gone on
  EXPECT_EQ(server.statistics().faults, 1u);
  Client after(server.port());
  after.Settle();
}

}  // namespace live_server_clients_test
}  // namespace oca::live
