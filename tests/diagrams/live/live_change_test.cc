// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <sstream>
#include <string>
#include <thread>

#include "oca/diagrams/live/live_run.h"
#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/record/mcap_sink.h"
#include "oca/diagrams/record/recording.h"
#include "tests/diagrams/live/ws_client.h"
#include "tests/temporary_folder.h"

namespace oca::live {
namespace live_change_test {

using testing::HasSubstr;
using testing::Not;

constexpr char kBall[] = R"(
name: ball
parameters: {slope: 2.0, tick: 0.01, idle: 1}
systems:
  obstacles:
    type: ObstacleSource
    obstacles: [{id: ball, shape: {type: sphere, radius: 0.1}, pose: {xyz: [0, 0, 1]}}]
  rate: {type: Constant, value: ["${slope}"]}
  x: {type: Integrator, initial: [0.0]}
  hold: {type: ZeroOrderHold, period: "${tick}", initial: [0.0]}
connections:
  - rate.value -> x.in
  - x.out -> hold.in
record: {signals: {"rate.value": 100}}
)";

/// A run on a thread of its own, recorded in memory, with a client that changes it.
class LiveChangeTest : public testing::Test {
 protected:
  explicit LiveChangeTest(const std::string& diagram = kBall, const std::string& used = "")
      : sink_(bytes_, record::Compression::kNone), server_(AnyPort()) {
    folder_.Write("used.yaml", used);
    options_.file = folder_.Write("ball.yaml", diagram);
    options_.interrupted = [this] { return stop_.load(); };
    options_.outputs = {&recording_};
    run_ = std::thread([this] { result_ = RunLive(options_, server_); });
  }
  ~LiveChangeTest() override {
    if (run_.joinable()) Stop();
  }
  static LiveOptions AnyPort() {
    LiveOptions options;
    options.port = 0;
    return options;
  }
  /// What was advertised to a client that came before the run is empty.
  static int ChannelOf(Client& client, const std::string& topic) {
    while (true) {
      const json advertised = client.ReadOp("advertise");
      for (const auto& channel : advertised["channels"]) {
        if (channel["topic"] == topic) return channel["id"];
      }
    }
  }
  /// Reads messages of a topic until one has `text` in it.
  static void WaitFor(Client& client, const std::string& text) {
    while (client.Read().find(text) == std::string::npos) {
    }
  }
  record::McapFile Stop() {
    stop_ = true;
    run_.join();
    return record::McapFile::Parse(bytes_.str(), "live");
  }

  test::TemporaryFolder folder_;
  std::ostringstream bytes_;
  record::McapSink sink_;
  record::Recording recording_{{&sink_}};
  std::atomic<bool> stop_{false};
  LiveServer server_;
  LiveRunOptions options_;
  LiveRunResult result_{};
  std::thread run_;
};

TEST_F(LiveChangeTest, AMovedObstacleIsAnInputAndKeepsItsPlaceWhenAParameterMakesTheDiagramAnew) {
  Client client(server_.port());
  const int rate = ChannelOf(client, "/rate/value");
  Client other(server_.port());
  client.Subscribe(ChannelOf(other, "/tf"), 1);
  WaitFor(client, R"("translation":{"x":0,"y":0,"z":1})");
  client.Send(R"({"op": "setParameters", "parameters":
      [{"name": "obstacles.ball.position", "value": [0.5, 2, 3]}]})");
  WaitFor(client, R"("translation":{"x":0.5,"y":2,"z":3})");
  client.Subscribe(rate, 2);
  client.Send(R"({"op": "setParameters", "parameters": [{"name": "slope", "value": 7.25}]})");
  WaitFor(client, R"([7.25])");
  WaitFor(client, R"("translation":{"x":0.5,"y":2,"z":3})");
  const record::McapFile file = Stop();
  EXPECT_FALSE(result_.run.failure);
  EXPECT_EQ(result_.changes, 2);
  // One record of it all.
  EXPECT_TRUE(file.complete()) << file.problem();
  EXPECT_NE(file.FindAttachment("diagram.yaml"), nullptr);
  EXPECT_EQ(file.MessagesOf("/metrics").size(), 1u);
  const auto values = file.MessagesOf("/rate/value");
  ASSERT_FALSE(values.empty());
  EXPECT_THAT(values.front()->data, HasSubstr("[2]"));
  EXPECT_THAT(values.back()->data, HasSubstr("[7.25]"));
  EXPECT_EQ(file.FindMetadata("oca")->at("outcome"), "interrupted");
}

TEST_F(LiveChangeTest, SaysWhyAChangeIsRefusedAndShowsTheValueThatCounts) {
  Client client(server_.port()), other(server_.port());
  ChannelOf(client, "/rate/value");
  client.Send(R"({"op": "subscribeParameterUpdates", "parameterNames": []})");
  client.Settle();
  client.Send(R"({"op": "setParameters", "id": "mine", "parameters":
      [{"name": "tick", "value": -1}]})");
  const auto tick = [](const json& answer) {
    for (const json& parameter : answer["parameters"]) {
      if (parameter["name"] == "tick") return parameter["value"].get<double>();
    }
    return 0.0;
  };
  EXPECT_EQ(tick(client.ReadOp("parameterValues")), -1.0);
  for (Client* const one : {&client, &other}) {
    const json status = one->ReadOp("status");
    EXPECT_EQ(status["level"], 2);
    EXPECT_THAT(status["message"].get<std::string>(), HasSubstr("change refused: "));
    EXPECT_THAT(status["message"].get<std::string>(), HasSubstr("period"));
  }
  EXPECT_EQ(tick(client.ReadOp("parameterValues")), 0.01);
  client.Send(R"({"op": "setParameters", "parameters": [{"name": "tick", "value": true}]})");
  EXPECT_THAT(client.ReadOp("status")["message"].get<std::string>(), HasSubstr("change refused: "));
  Stop();
  EXPECT_FALSE(result_.run.failure);
  EXPECT_EQ(result_.changes, 0);
}

TEST_F(LiveChangeTest, ShowsAndRecordsWhatTheDiagramIsWarnedOf) {
  Client client(server_.port());
  ChannelOf(client, "/rate/value");
  Client late(server_.port());
  const json shown = json::parse(
      late.ReadOp("serverInfo")["metadata"]["oca.warnings/warnings"].get<std::string>());
  ASSERT_EQ(shown.size(), 1u);
  EXPECT_THAT(shown[0].get<std::string>(), HasSubstr("ball.yaml:3"));
  EXPECT_THAT(shown[0].get<std::string>(), HasSubstr("warning: parameters.idle: nothing uses it"));
  const record::McapFile file = Stop();
  EXPECT_EQ(file.FindMetadata("oca.warnings")->at("warnings"), shown.dump());
  const json line = json::parse(file.MessagesOf("/log").at(0)->data);
  EXPECT_EQ(line["level"], 3);
  EXPECT_EQ(line["message"], shown[0]);
}

TEST_F(LiveChangeTest, TellsWhoLooksOnWhatChangedOfTheDiagram) {
  Client client(server_.port());
  ChannelOf(client, "/rate/value");
  Client late(server_.port());
  const json before = late.ReadOp("serverInfo");
  EXPECT_EQ(before["metadata"]["oca.parameters/slope"], "2.0");
  late.Send(R"({"op": "setParameters", "parameters": [{"name": "slope", "value": 7.25}]})");
  json after = late.ReadOp("serverInfo");
  EXPECT_EQ(after["metadata"]["oca.parameters/slope"], "7.25");
  EXPECT_EQ(after["sessionId"], before["sessionId"]);  // the run goes on
}

/// Two uses of a file with an obstacle.
class LiveNestingTest : public LiveChangeTest {
 protected:
  LiveNestingTest()
      : LiveChangeTest(
            "systems:\n"
            "  left: {type: Diagram, file: used.yaml}\n"
            "  right: {type: Diagram, file: used.yaml}\n"
            "record: {signals: {left.obstacles.obstacles: 100, right.obstacles.obstacles: 100}}\n",
            kBall) {}
};

TEST_F(LiveNestingTest, AnObstacleOfEachUseOfAFileIsMovedByItsPath) {
  Client client(server_.port());
  client.Subscribe(ChannelOf(client, "/right/obstacles/obstacles"), 1);
  client.Send(R"({"op": "setParameters", "parameters":
      [{"name": "right.obstacles.ball.position", "value": [0.5, 2, 3]}]})");
  WaitFor(client, R"("xyz":[0.5,2)");
  const record::McapFile file = Stop();
  EXPECT_FALSE(result_.run.failure);
  EXPECT_EQ(result_.changes, 1);
  EXPECT_THAT(file.MessagesOf("/right/obstacles/obstacles").back()->data,
              HasSubstr(R"("xyz":[0.5,2)"));
  EXPECT_THAT(file.MessagesOf("/left/obstacles/obstacles").back()->data,
              Not(HasSubstr(R"("xyz":[0.5)")));
}

}  // namespace live_change_test
}  // namespace oca::live
