// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/live_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/live/server_bench.h"
#include "tests/diagrams/live/ws_client.h"

namespace oca::live {
namespace live_server_test {

using server_bench::AnyPort;
using server_bench::kChannels;
using testing::HasSubstr;

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

}  // namespace live_server_test
}  // namespace oca::live
