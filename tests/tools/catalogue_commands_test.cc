// SPDX-License-Identifier: BSD-3-Clause
// What the program says of its types, of the keys of files, and of a diagram's wiring.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/small_diagram.h"

namespace oca::tools {
namespace catalogue_commands_test {

using nlohmann::json;
using testing::HasSubstr;

class CatalogueCommandsTest : public CommandLineTest {};

TEST_F(CatalogueCommandsTest, ListAndDescribeKnowTheSameTypes) {
  const Ran list = run("$S list");
  EXPECT_EQ(list.status, 0);
  std::istringstream lines(list.out);
  int types = 0;
  for (std::string line; std::getline(lines, line); ++types) {
    const std::string type = line.substr(0, line.find(' '));
    EXPECT_GT(line.size(), type.size() + 10) << line;
    const Ran described = run("$S describe " + type);
    EXPECT_EQ(described.status, 0) << type << described.err;
    for (const char* part : {"ports\n", "parameters\n"})
      EXPECT_THAT(described.out, HasSubstr(part));
  }
  EXPECT_GE(types, 25);
  const std::string limiter = run("$S describe DeltaLimiter").out;
  for (const char* part : {"max_joint_velocity", "rad/s", "limited_delta", "default"}) {
    EXPECT_THAT(limiter, HasSubstr(part));
  }
}

TEST_F(CatalogueCommandsTest, TheReferenceHasEveryTypeWithItsPortsAndParameters) {
  const Ran page = run("$S docs systems");
  EXPECT_EQ(page.status, 0);
  const Ran list = run("$S list");
  std::istringstream types(list.out);
  for (std::string line; std::getline(types, line);) {
    const std::string type = line.substr(0, line.find(' '));
    if (type == "Diagram") continue;  // has its keys in the page of the file
    EXPECT_THAT(page.out, HasSubstr("\n## " + type + "\n"));
  }
  EXPECT_THAT(page.out, HasSubstr("| input | `delta` | Vector, u |\n"));
  EXPECT_THAT(page.out, HasSubstr("| `force_gain` | number | N m^3 | `1` | >= 0 | gain eta of eq. "
                                  "(3.1) |\n"));
}

TEST_F(CatalogueCommandsTest, TheReferenceOfTheFileHasEverySection) {
  const Ran page = run("$S docs diagram_file");
  EXPECT_EQ(page.status, 0);
  for (const char* key :
       {"name", "include", "simulator", "models", "systems", "record", "expect"}) {
    EXPECT_THAT(page.out, HasSubstr("\n## " + std::string(key) + "\n"));
  }
  EXPECT_THAT(page.out, HasSubstr("| `NAME.attached[].shape.radius` | number | m |  | > 0 |"));
  EXPECT_THAT(page.out, HasSubstr("The type `Diagram` "));
  EXPECT_EQ(run("$S docs nothing").status, 64);
}

TEST_F(CatalogueCommandsTest, TheSchemaIsJsonAndKnowsEveryTypeAndKey) {
  const Ran ran = run("$S schema");
  EXPECT_EQ(ran.status, 0);
  const json schema = json::parse(ran.out);
  EXPECT_THAT(schema["$schema"].get<std::string>(), HasSubstr("draft-07"));
  for (const char* key : {"name", "include", "parameters", "simulator", "models", "systems",
                          "connections", "record", "expect", "packages"}) {
    EXPECT_TRUE(schema["properties"].contains(key)) << key;
  }
  for (const char* part : {"DeltaLimiter", "max_joint_velocity", "at_least"}) {
    EXPECT_THAT(ran.out, HasSubstr(part));
  }
}

TEST_F(CatalogueCommandsTest, TheSchemaRequiresOfMapsOnlyWhatNoOtherFileCanSay) {
  const json schema = json::parse(run("$S schema").out);
  EXPECT_FALSE(schema["properties"]["systems"]["additionalProperties"].contains("required"));
  EXPECT_FALSE(schema["properties"]["models"]["additionalProperties"].contains("required"));
  // A file with a name that includes nothing is whole.
  EXPECT_EQ(schema["if"], json::parse(R"({"required":["name"],"not":{"required":["include"]}})"));
  const json& whole = schema["then"]["properties"];
  EXPECT_EQ(whole["systems"]["additionalProperties"]["required"], json::parse(R"(["type"])"));
  EXPECT_EQ(whole["models"]["additionalProperties"]["oneOf"],
            json::parse(R"([{"required":["urdf"]},{"required":["xacro"]}])"));
}

TEST_F(CatalogueCommandsTest, TheSchemaBoundsNumbersBesideTheExpressionsThatMayStandForThem) {
  const json schema = json::parse(run("$S schema").out);
  const json& duration = schema["properties"]["simulator"]["properties"]["duration"];
  EXPECT_EQ(duration["type"], json::parse(R"(["number","string"])"));
  EXPECT_EQ(duration["minimum"], 0.0);
  EXPECT_EQ(duration["pattern"], R"(\$\{.*\})");
}

TEST_F(CatalogueCommandsTest, GraphsDrawEverySystemAndConnection) {
  const std::string file = Small();
  const Ran dot = run("$S graph " + file);
  EXPECT_EQ(dot.status, 0);
  EXPECT_THAT(dot.out, testing::StartsWith("digraph \"small\" {"));
  EXPECT_THAT(dot.out, HasSubstr("\"source\" -> \"lag\""));
  const Ran mermaid = run("$S graph " + file + " --format mermaid");
  EXPECT_EQ(mermaid.status, 0);
  EXPECT_THAT(mermaid.out, testing::StartsWith("flowchart LR\n"));
  EXPECT_THAT(mermaid.out, HasSubstr("s_source -->|value → in| s_lag"));
}

TEST_F(CatalogueCommandsTest, GraphsAreDrawnBySvgWhereGraphvizIs) {
  if (run("command -v dot").status != 0) GTEST_SKIP() << "no graphviz here";
  std::string text = kSmall;
  text.replace(text.find("name: small"), 11, "name: 'a \"quoted\" \\ name'");
  for (auto at = text.find("source"); at != std::string::npos; at = text.find("source", at + 1)) {
    text.replace(at, 6, "graph");  // a word of the DOT language
  }
  const Ran ran = run("$S graph " + run.folder().Write("g.yaml", text).string() + " --format svg");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("<svg"));
}

}  // namespace catalogue_commands_test
}  // namespace oca::tools
