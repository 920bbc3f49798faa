// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/live_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/live/ws_client.h"

namespace oca::live {
namespace live_server_test {

using testing::HasSubstr;
using namespace std::chrono_literals;

const std::vector<record::RecordChannel> kChannels{{"/tf", "foxglove.FrameTransforms", "{}"},
                                                   {"/scene/robots", "foxglove.SceneUpdate", "{}"},
                                                   {"/plant/position", "oca.Joints", "{}"}};

LiveOptions AnyPort() {
  LiveOptions options;
  options.port = 0;
  options.page = "<html>the page</html>";
  return options;
}

http::response<http::string_body> Fetch(int port, http::verb verb, const std::string& target) {
  asio::io_context io;
  tcp::socket socket = Connect(io, port);
  http::request<http::string_body> request{verb, target, 11};
  request.set(http::field::host, "localhost");
  http::write(socket, request);
  beast::flat_buffer buffer;
  http::response_parser<http::string_body> parser;
  parser.skip(verb == http::verb::head);
  http::read(socket, buffer, parser);
  return parser.release();
}

::testing::AssertionResult Eventually(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + 20s;
  while (std::chrono::steady_clock::now() < end) {
    if (holds()) return ::testing::AssertionSuccess();
    std::this_thread::sleep_for(2ms);
  }
  return ::testing::AssertionFailure() << "not within 20 s";
}

TEST(LiveServerTest, ServesThePageAndTheRecord) {
  LiveOptions options = AnyPort();
  options.record = std::string("\x89MCAP0\r\n\0bytes", 14);
  const LiveServer server(options);
  const auto page = Fetch(server.port(), http::verb::get, "/?theme=dark");
  EXPECT_EQ(page.result_int(), 200u);
  EXPECT_EQ(page.body(), "<html>the page</html>");
  const auto record = Fetch(server.port(), http::verb::get, "/record.mcap");
  EXPECT_EQ(record.body(), options.record);
}

TEST(LiveServerTest, ServesNothingElse) {
  const LiveServer server(AnyPort());
  EXPECT_EQ(Fetch(server.port(), http::verb::get, "/record.mcap").result_int(), 404u);
  EXPECT_EQ(Fetch(server.port(), http::verb::get, "/../etc/passwd").result_int(), 404u);
  EXPECT_EQ(Fetch(server.port(), http::verb::post, "/").result_int(), 405u);
  const auto head = Fetch(server.port(), http::verb::head, "/");
  EXPECT_EQ(head.result_int(), 200u);
  EXPECT_EQ(head.body(), "");
}

TEST(LiveServerTest, RefusesAPortThatIsTaken) {
  const LiveServer server(AnyPort());
  LiveOptions options = AnyPort();
  options.port = server.port();
  try {
    const LiveServer second(options);
    FAIL() << "two servers on one port";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr(std::to_string(server.port())));
  }
}

TEST(LiveServerTest, RefusesWhatIsNoAddressAndNoPort) {
  LiveOptions options = AnyPort();
  options.address = "localhost:80";
  EXPECT_THROW(LiveServer{options}, ConfigError);
  options = AnyPort();
  options.port = 65536;
  EXPECT_THROW(LiveServer{options}, ConfigError);
  options.port = -1;
  EXPECT_THROW(LiveServer{options}, ConfigError);
}

TEST(LiveServerTest, GreetsWithItsChannels) {
  LiveServer server(AnyPort());
  server.AddMetadata({"oca", {{"version", "0.1.0"}}});
  server.Begin(kChannels);
  Client client(server.port());
  EXPECT_EQ(client.Protocol(), "foxglove.websocket.v1");
  const json info = client.ReadOp("serverInfo");
  EXPECT_EQ(info["metadata"]["version"], "0.1.0");
  const json advertised = client.ReadOp("advertise");
  ASSERT_EQ(advertised["channels"].size(), 3u);
  EXPECT_EQ(advertised["channels"][2]["topic"], "/plant/position");
  EXPECT_EQ(advertised["channels"][2]["encoding"], "json");
}

TEST(LiveServerTest, HasASessionThatNoOtherServerHas) {
  const auto session = [](const LiveServer& server) {
    return Client(server.port()).ReadOp("serverInfo")["sessionId"].get<std::string>();
  };
  LiveServer server(AnyPort()), other(AnyPort());
  server.Begin(kChannels);
  other.Begin(kChannels);
  const std::string first = session(server);
  EXPECT_NE(first, session(other));
  EXPECT_EQ(first, session(server));
  server.Begin(kChannels);  // goes on
  EXPECT_EQ(first, session(server));
  server.Begin({kChannels[0]});
  EXPECT_NE(first, session(server));
}

TEST(LiveServerTest, TellsALineToAll) {
  LiveServer server(AnyPort());
  Client one(server.port()), two(server.port());
  one.Settle();
  two.Settle();
  server.Tell(StatusLevel::kWarning, "mind the gap \xff");
  for (Client* const client : {&one, &two}) {
    const json status = client->ReadOp("status");
    EXPECT_EQ(status["level"], 1);
    EXPECT_THAT(status["message"].get<std::string>(), HasSubstr("mind the gap"));
  }
}

TEST(LiveServerTest, SaysItsLastWordBeforeItGoes) {
  auto server = std::make_unique<LiveServer>(AnyPort());
  Client client(server->port());
  client.Settle();
  for (int i = 0; i < 200; ++i) server->Tell(StatusLevel::kInfo, std::string(1000, 'x'));
  server->Tell(StatusLevel::kError, "the run failed");
  server.reset();
  json status;
  do {
    status = client.ReadOp("status");
  } while (status["level"] == 0);
  EXPECT_EQ(status["message"], "the run failed");
}

TEST(LiveServerTest, SendsWhatAClientSubscribedToAndNothingElse) {
  LiveServer server(AnyPort());
  server.Begin(kChannels);
  Client client(server.port());
  client.Subscribe(2, 77);
  client.Settle();
  server.Write(0, {R"({"not": "wanted"})", 1});
  server.Write(2, {R"({"a1": 0.5})", 0x0102030405060708});
  const std::string message = client.Read();
  // Opcode 1, subscription 77, then the time, least byte first.
  EXPECT_EQ(message.substr(0, 13),
            std::string("\x01\x4d\x00\x00\x00\x08\x07\x06\x05\x04\x03\x02\x01", 13));
  EXPECT_EQ(message.substr(13), R"({"a1": 0.5})");
}

TEST(LiveServerTest, ShowsTheRobotsToWhoComesLate) {
  LiveServer server(AnyPort());
  server.Begin(kChannels);
  server.Write(1, {R"({"entities": []})", 5});
  server.Write(2, {R"({"a1": 0.5})", 6});
  Client client(server.port());
  client.Subscribe(2, 2);
  client.Subscribe(1, 1);
  client.ReadOp("advertise");
  EXPECT_THAT(client.Read(), HasSubstr("entities"));
}

TEST(LiveServerTest, StopsWhenAClientUnsubscribes) {
  LiveServer server(AnyPort());
  server.Begin(kChannels);
  Client client(server.port());
  client.Subscribe(0, 1);
  client.Subscribe(2, 2);
  client.Send(R"({"op": "unsubscribe", "subscriptionIds": [1]})");
  client.Settle();
  server.Write(0, {"{}", 1});
  server.Write(2, {R"({"a1": 1})", 1});
  EXPECT_THAT(client.Read(), HasSubstr("a1"));
}

TEST(LiveServerTest, TakesParametersOfTheirOwnTypeAlone) {
  LiveServer server(AnyPort());
  server.SetParameters({{"gain", 1.0},
                        {"avoid", true},
                        {"obstacles.box.position", std::vector<double>{0.0, 1.0, 2.0}}});
  Client client(server.port());
  client.Send(R"({"op": "setParameters", "id": "x", "parameters":
                  [{"name": "gain", "value": 2.5},
                   {"name": "obstacles.box.position", "value": [3, 4, 5]}]})");
  EXPECT_EQ(client.ReadOp("parameterValues")["parameters"][0]["value"], 2.5);
  const auto changes = server.TakeChanges();
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].name, "gain");
  EXPECT_EQ(std::get<double>(changes[0].value), 2.5);
  EXPECT_THAT(std::get<std::vector<double>>(changes[1].value), testing::ElementsAre(3, 4, 5));
  EXPECT_TRUE(server.TakeChanges().empty());

  for (const char* const bad :
       {R"([{"name": "gain", "value": "much"}])", R"([{"name": "gain", "value": null}])",
        R"([{"name": "gain", "value": 1e999}])", R"([{"name": "avoid", "value": 1}])",
        R"([{"name": "loss", "value": 1}])",
        R"([{"name": "obstacles.box.position", "value": [1]}])", R"([{"value": 1}])", "7"}) {
    client.Send(std::string(R"({"op": "setParameters", "parameters": )") + bad + "}");
    EXPECT_EQ(client.ReadOp("status")["level"], 2) << bad;
  }
  EXPECT_TRUE(server.TakeChanges().empty());
  EXPECT_EQ(server.statistics().malformed, 8u);
}

TEST(LiveServerTest, KeepsTheLastOfManyChangesOfOneParameter) {
  LiveServer server(AnyPort());
  server.SetParameters({{"gain", 1.0}});
  Client client(server.port());
  for (int i = 0; i < 100; ++i) {
    client.Send(
        json{{"op", "setParameters"}, {"parameters", {{{"name", "gain"}, {"value", i}}}}}.dump());
  }
  client.Settle();
  const auto changes = server.TakeChanges();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(std::get<double>(changes[0].value), 99.0);
}

TEST(LiveServerTest, TellsOtherWatchersOfAChange) {
  LiveServer server(AnyPort());
  server.SetParameters({{"gain", 1.0}});
  Client watcher(server.port()), setter(server.port());
  watcher.Send(R"({"op": "subscribeParameterUpdates", "parameterNames": []})");
  watcher.Settle();
  setter.Send(R"({"op": "setParameters", "parameters": [{"name": "gain", "value": 7}]})");
  EXPECT_EQ(watcher.ReadOp("parameterValues")["parameters"][0]["value"], 7.0);
}

TEST(LiveServerTest, OutlivesGarbage) {
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

TEST(LiveServerTest, HangsUpOnAMessageThatIsTooLarge) {
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

TEST(LiveServerTest, OutlivesAFloodOfQuestionsThatNobodyReadsTheAnswersOf) {
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

TEST(LiveServerTest, OutlivesAHundredThatComeAndGo) {
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

TEST(LiveServerTest, NeverWaitsForAClientThatStopsReading) {
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

TEST(LiveServerTest, RefusesMoreConnectionsThanItWants) {
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

}  // namespace live_server_test
}  // namespace oca::live
