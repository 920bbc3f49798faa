// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/schema_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/params.h"

namespace oca::tools {
namespace schema_table_test {

using nlohmann::ordered_json;
using testing::HasSubstr;

struct Inner {
  double radius{0.1};
  static void Describe(Fields<Inner>& fields) {
    fields.Add("radius", &Inner::radius, "m", "of a ball").Above(0.0).AtMost(2.0);
  }
};

struct Outer {
  PerComponent gain{1.0};
  Eigen::Vector3d axis{0.0, 0.0, 1.0};
  Period period{};
  std::vector<Inner> balls;
  std::vector<std::string> links;
  static void Describe(Fields<Outer>& fields) {
    fields.Add("gain", &Outer::gain, "1/s", "pairs [a, b]").AtLeast(0.0);
    fields.Add("axis", &Outer::axis, "", "one | two");
    fields.Add("period", &Outer::period, "s", "of control").Above(0.0).Required();
    fields.Add("balls", &Outer::balls, "", "that stand").Required();
    fields.Add("links", &Outer::links, "", "by name");
  }
};

std::string Table() {
  Outer defaults;
  return SchemaTable(SchemaOfFields(FieldsOf<Outer>(), &defaults));
}

TEST(SchemaTableTest, HasARowForEachKeyWithItsUnitDefaultBoundsAndMeaning) {
  const std::string table = Table();
  EXPECT_THAT(table, HasSubstr("| `gain` | number or list of numbers | 1/s | `1` | >= 0 | "
                               "pairs [a, b] |\n"));
  EXPECT_THAT(table, HasSubstr("| `axis` | list of 3 numbers |  | `[0,0,1]` |  | one \\| two |\n"));
  EXPECT_THAT(table, HasSubstr("| `links` | list of texts |  | `[]` |  | by name |\n"));
}

TEST(SchemaTableTest, ListsWhatIsInsideBelowIt) {
  EXPECT_THAT(Table(), HasSubstr("| `balls` | list of maps |  | required |  | that stand |\n"
                                 "| `balls[].radius` | number | m | `0.1` | in (0, 2] | of a "
                                 "ball |\n"));
}

TEST(SchemaTableTest, SaysThatAPeriodOrAFrequencyIsRequired) {
  EXPECT_THAT(Table(), HasSubstr("| `period` | number | s | required, or `frequency` | > 0 |"));
  EXPECT_THAT(Table(), HasSubstr("| `frequency` | number | Hz |  | > 0 | instead of period |\n"));
}

TEST(SchemaTableTest, LooksThroughTheAlternativeOfAnExpression) {
  const ordered_json schema = ordered_json::parse(R"({"type": "object", "additionalProperties":
    {"anyOf": [{"type": "object", "properties": {"rate": {"anyOf": [
      {"type": "number", "exclusiveMinimum": 0, "x-unit": "Hz"},
      {"type": "string", "pattern": "\\$\\{.*\\}"}], "description": "how often [Hz]"}}},
      {"type": "string", "pattern": "\\$\\{.*\\}"}]}})");
  EXPECT_THAT(SchemaTable(schema),
              HasSubstr("| `NAME.rate` | number | Hz |  | > 0 | how often |\n"));
}

TEST(SchemaTableTest, OfNothingIsEmpty) {
  EXPECT_EQ(SchemaTable(ordered_json::parse(R"({"type": "string"})")), "");
}

}  // namespace schema_table_test
}  // namespace oca::tools
