// SPDX-License-Identifier: BSD-3-Clause
// What is wrong within a record is told with the record's name and the place in it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "oca/diagrams/record/comparison.h"
#include "oca/diagrams/record/extracted_record.h"
#include "oca/diagrams/record/mcap_writer.h"
#include "oca/diagrams/record/run_metadata.h"
#include "oca/framework/dataflow/error.h"

namespace oca::record {
namespace record_places_test {

using testing::StartsWith;
using testing::ThrowsMessage;

/// A record `name` with these warnings, metrics and files.
McapFile Made(const std::string& name, const std::string& warnings, const std::string& metrics,
              const std::vector<Attachment>& files = {}) {
  std::ostringstream stream;
  McapWriter writer(stream, Compression::kNone);
  for (const Attachment& file : files) writer.AddAttachment(file);
  writer.AddMetadata({"oca.warnings", {{"warnings", warnings}}});
  writer.Write(writer.AddChannel("/metrics", "json", 0), 0, metrics);
  writer.Close();
  return McapFile::Parse(stream.str(), name);
}

TEST(RecordPlacesTest, MetadataThatIsNoJsonIsToldWithFileAndField) {
  EXPECT_THAT(WarningsOf(Made("a.mcap", "[\"one\", 2, \"three\"]", "{}")),
              testing::ElementsAre("one", "three"));
  for (const std::string& text : {std::string("not"), std::string(5000, '['),
                                  std::string("[1e999]"), std::string("[\"\\q\"]")}) {
    EXPECT_THAT(
        [&] { WarningsOf(Made("a.mcap", text, "{}")); },
        ThrowsMessage<ConfigError>(StartsWith("a.mcap: metadata oca.warnings: warnings: JSON: ")));
  }
}

TEST(RecordPlacesTest, OfTwoRecordsTheOneThatIsWrongIsNamed) {
  const McapFile good = Made("good.mcap", "[]", "{\"x\": 1}");
  const McapFile bad = Made("bad.mcap", "[]", "{\"x\": 1");
  const auto places = ThrowsMessage<ConfigError>(StartsWith("bad.mcap: /metrics: message 0: JSON"));
  EXPECT_THAT([&] { Compare(good, bad); }, places);
  EXPECT_THAT([&] { Compare(bad, good); }, places);
  EXPECT_EQ(Compare(good, good).metrics.size(), 1u);
}

TEST(RecordPlacesTest, FilesThatComeAlongAreToldWithTheRecord) {
  EXPECT_THAT([] { ExtractedRecord(Made("a.mcap", "[]", "{}")); },
              ThrowsMessage<ConfigError>(StartsWith("a.mcap: has no attachment diagram.yaml")));
  EXPECT_THAT(
      [] {
        ExtractedRecord(
            Made("a.mcap", "[]", "{}", {{0, "diagram.yaml", "", ""}, {0, "../b", "", ""}}));
      },
      ThrowsMessage<ConfigError>(StartsWith("a.mcap: attachment; got '../b'")));
}

TEST(RecordPlacesTest, TheListOfSourcesIsToldByWhatIsWrongInIt) {
  const auto refusal = [](const std::string& sources) -> std::string {
    try {
      const ExtractedRecord extracted(
          Made("a.mcap", "[]", "{}",
               {{0, "diagram.yaml", "", "systems: {}\n"}, {0, "sources.yaml", "", sources}}));
      extracted.Load({});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  using testing::HasSubstr;
  EXPECT_THAT(refusal("a: ["), HasSubstr("sources.yaml:1:"));
  EXPECT_THAT(refusal("overrides: []"), HasSubstr("sources.yaml: diagram: got no file"));
  EXPECT_THAT(refusal("diagram: ../../etc/passwd"),
              HasSubstr("sources.yaml: diagram: got no file"));
  EXPECT_THAT(refusal("{diagram: diagram.yaml, overrides: [x]}"),
              HasSubstr("sources.yaml: overrides: got no change; expected PATH=VALUE"));
}

}  // namespace record_places_test
}  // namespace oca::record
