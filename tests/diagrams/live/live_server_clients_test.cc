// SPDX-License-Identifier: BSD-3-Clause
// That a LiveServer outlives its clients: garbage, floods, many, and those that do not read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <chrono>
#include <random>
#include <string>
#include <thread>

#include "oca/diagrams/live/live_server.h"
#include "tests/diagrams/live/server_bench.h"
#include "tests/diagrams/live/ws_client.h"

namespace oca::live {
namespace live_server_clients_test {

using server_bench::AnyPort;
using server_bench::Eventually;
using server_bench::kChannels;
using testing::HasSubstr;
using namespace std::chrono_literals;

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
  LiveServer server(options);
  Client one(server.port()), two(server.port());
  one.Settle();
  two.Settle();
  EXPECT_THROW(Client(server.port()), boost::system::system_error);
  EXPECT_EQ(server.statistics().refused, 1u);
  one.Close();
  EXPECT_TRUE(Eventually([&] { return server.statistics().clients == 1; }));
  Client three(server.port());
  three.Settle();
}

}  // namespace live_server_clients_test
}  // namespace oca::live
