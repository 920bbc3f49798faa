// SPDX-License-Identifier: BSD-3-Clause
// A record and a report of one run, as a program in C++ makes them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>

#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/record/mcap_sink.h"
#include "oca/diagrams/record/record.h"
#include "oca/diagrams/record/report.h"
#include "oca/diagrams/record/run_source.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/version.h"
#include "tests/temporary_folder.h"

namespace oca::record {
namespace record_report_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr char kRamp[] = R"(
name: ramp
parameters: {slope: 1, idle: 2}
simulator: {duration: 1}
systems: {ramp: {type: RampSource, slope: "${slope}"}}
record: {signals: {"ramp.value": 10}}
)";

class RecordReportTest : public testing::Test {
 protected:
  RecordReportTest() {
    std::ofstream(page_) << "<head><!--oca:source--></head>";
    setenv("OCA_VIEWER", page_.c_str(), 1);
  }
  ~RecordReportTest() override { unsetenv("OCA_VIEWER"); }
  static std::string Text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  const oca::test::TemporaryFolder folder_;
  const fs::path page_{folder_.path() / "viewer.html"};
  const fs::path record_{folder_.path() / "a.mcap"}, report_{folder_.path() / "a.html"};
  const fs::path diagram_{folder_.Write("ramp.yaml", kRamp)};
};

TEST_F(RecordReportTest, AreOutputsOfOneRun) {
  const auto loaded = loading::LoadDiagram(diagram_, {{"parameters.slope", "3"}});
  Record record(record_);
  Report report(report_);
  const runs::RunResult result = runs::Run(loaded, {.outputs = {&record, &report}});
  EXPECT_FALSE(result.failure);
  EXPECT_EQ(record.dropped(), 0);
  const McapFile file = McapFile::Read(record_);
  EXPECT_TRUE(file.complete()) << file.problem();
  EXPECT_EQ(file.MessagesOf("/ramp/value").size(), 11u);
  EXPECT_EQ(file.MessagesOf("/metrics").at(0)->data, "{}");
  EXPECT_EQ(file.FindMetadata("oca")->at("version"), Version());
  EXPECT_EQ(file.FindMetadata("oca.overrides")->at("parameters.slope"), "3");
  EXPECT_THAT(Text(report_), testing::StartsWith("<head><script id=\"oca-record\""));
}

TEST_F(RecordReportTest, ASecondRunTakesThePlaceOfTheFirst) {
  const auto loaded = loading::LoadDiagram(diagram_);
  Record record(record_);
  Report report(report_);
  for (const double duration : {1.0, 0.5}) {
    runs::Run(loaded, {.duration = duration, .outputs = {&record, &report}});
  }
  EXPECT_EQ(McapFile::Read(record_).MessagesOf("/ramp/value").size(), 6u);
  EXPECT_THAT(Text(report_), testing::EndsWith("</script></head>"));
}

TEST_F(RecordReportTest, SayBeforeTheRunWhatCannotBeWritten) {
  const auto loaded = loading::LoadDiagram(diagram_);
  int steps = 0;
  const auto run = [&](runs::RunOutput& output) {
    runs::Run(loaded, {.progress = [&](double) { return ++steps > 0; }, .outputs = {&output}});
  };
  Record nowhere("/nowhere/a.mcap");
  EXPECT_THAT([&] { run(nowhere); }, ThrowsMessage<ConfigError>(HasSubstr("cannot be written")));
  Report over_the_diagram(diagram_);
  EXPECT_THAT([&] { run(over_the_diagram); }, ThrowsMessage<ConfigError>(HasSubstr("report: ")));
  EXPECT_EQ(steps, 0);
  EXPECT_EQ(Text(diagram_), kRamp);
}

TEST_F(RecordReportTest, ADiagramOfARecordHasTheWarningsOfTheFileItWasMadeFrom) {
  const RunSource source(diagram_);
  ASSERT_EQ(source.loaded().warnings.size(), 1u);
  EXPECT_THAT(source.loaded().warnings[0], HasSubstr("parameters.idle: nothing uses it"));
  Record record(record_);
  runs::Run(source.loaded(), {.outputs = {&record}});
  const RunSource again(record_);
  EXPECT_EQ(again.loaded().warnings, source.loaded().warnings);
  EXPECT_EQ(again.loaded().name, "ramp");
}

/// Counts who asks for text.
class Reader final : public RecordSink {
 public:
  explicit Reader(bool reads) : reads_(reads) {}
  void Begin(const std::vector<RecordChannel>& channels) override { channels_ = channels; }
  void Write(int channel, const RecordSample& sample) override {
    if (channels_.at(static_cast<std::size_t>(channel)).topic != "/ramp/value") return;
    last = *static_cast<const double*>(sample.value());
    if (!reads_) return;
    text = sample.json();
    place = sample.json().data();
  }
  double last{0.0};
  std::string text;
  const char* place{nullptr};

 private:
  const bool reads_;
  std::vector<RecordChannel> channels_;
};

TEST_F(RecordReportTest, SinksGetValuesAndShareTheirText) {
  Reader values(false), first(true), second(true);
  Recording recording({&values, &first, &second});
  runs::Run(loading::LoadDiagram(diagram_), {.outputs = {&recording}});
  EXPECT_EQ(values.last, 1.0);
  EXPECT_EQ(first.text, "{\"values\":[1]}");
  EXPECT_EQ(second.text, first.text);
  EXPECT_EQ(second.place, first.place) << "one text for both";
}

TEST(RecordSampleTest, IsNoTextUntilSomebodyAsks) {
  const SignalFormat format{"gain", "out", &kVectorType, 2, "", {}};
  const double numbers[] = {0.5, -1.0};
  std::string text = "untouched";
  const RecordSample sample(format, numbers, 7, text);
  EXPECT_EQ(sample.time(), 7u);
  EXPECT_EQ(sample.value(), numbers);
  EXPECT_EQ(text, "untouched");
  EXPECT_EQ(sample.json(), "{\"values\":[0.5,-1]}");
  const RecordSample message("{}", 8);
  EXPECT_EQ(message.value(), nullptr);
  EXPECT_EQ(message.json(), "{}");
}

TEST(McapSinkTest, GoesOnWithTheChannelsItKnows) {
  std::ostringstream stream;
  McapSink sink(stream, Compression::kNone);
  sink.Begin({{"/a", "A", "{}"}, {"/b", "B", "{}"}});
  sink.Write(1, {"{\"n\":1}", 1});
  sink.Begin({{"/new", "A", "{}"}, {"/b", "B", "{}"}, {"/a", "A", "{}"}});
  sink.Write(0, {"{\"n\":2}", 2});
  sink.Write(1, {"{\"n\":3}", 3});
  sink.Write(2, {"{\"n\":4}", 4});
  sink.End();
  const McapFile file = McapFile::Parse(stream.str(), "memory");
  EXPECT_TRUE(file.complete()) << file.problem();
  EXPECT_EQ(file.channels().size(), 3u);
  EXPECT_EQ(file.schemas().size(), 2u);
  ASSERT_EQ(file.MessagesOf("/b").size(), 2u);
  EXPECT_EQ(file.MessagesOf("/b")[1]->data, "{\"n\":3}");
  EXPECT_EQ(file.MessagesOf("/a").at(0)->data, "{\"n\":4}");
  EXPECT_EQ(file.MessagesOf("/new").at(0)->data, "{\"n\":2}");
}

}  // namespace record_report_test
}  // namespace oca::record
