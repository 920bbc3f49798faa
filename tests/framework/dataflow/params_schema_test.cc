// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/params.h"
#include "tests/framework/dataflow/example_params.h"

namespace oca {
namespace params_schema_test {

using nlohmann::json;

json Schema() {
  const Everything defaults;
  return json::parse(SchemaOfFields(FieldsOf<Everything>(), &defaults).dump());
}

TEST(ParamsSchemaTest, IsAClosedObjectThatRequiresWhatIsRequired) {
  const json schema = Schema();
  EXPECT_EQ(schema["type"], "object");
  EXPECT_EQ(schema["additionalProperties"], false);
  EXPECT_EQ(schema["required"], json::parse(R"(["count"])"));
  EXPECT_EQ(schema["properties"].size(), FieldsOf<Everything>().size() + 1);  // and frequency
}

TEST(ParamsSchemaTest, CarriesTypesBoundsAndUnits) {
  const json properties = Schema()["properties"];
  EXPECT_EQ(properties["gain"]["type"], "number");
  EXPECT_EQ(properties["gain"]["minimum"], 0.0);
  EXPECT_EQ(properties["gain"]["maximum"], 10.0);
  EXPECT_EQ(properties["gain"]["description"], "how strong [N m^2]");
  EXPECT_EQ(properties["gain"]["x-unit"], "N m^2");
  EXPECT_FALSE(properties["enabled"].contains("x-unit"));
  EXPECT_EQ(properties["enabled"]["description"], "whether");
  EXPECT_EQ(properties["count"]["type"], "integer");
  EXPECT_EQ(properties["count"]["minimum"], 1.0);
  EXPECT_EQ(properties["enabled"]["type"], "boolean");
  EXPECT_EQ(properties["name"]["type"], "string");
  EXPECT_EQ(properties["method"]["enum"], json::parse(R"(["transpose", "damped"])"));
  EXPECT_EQ(properties["period"]["exclusiveMinimum"], 0.0);
  EXPECT_FALSE(properties["period"].contains("minimum"));
  EXPECT_EQ(properties["frequency"]["exclusiveMinimum"], 0.0);
  EXPECT_EQ(properties["limit"]["exclusiveMinimum"], 0.0);
  EXPECT_EQ(properties["limit"]["items"]["maximum"], 5.0);
  EXPECT_EQ(properties["axis"]["minItems"], 3);
  EXPECT_EQ(properties["axis"]["maxItems"], 3);
  EXPECT_EQ(properties["waypoints"]["items"]["properties"]["time"]["minimum"], 0.0);
  EXPECT_EQ(properties["waypoints"]["items"]["required"], json::parse(R"(["time"])"));
  EXPECT_EQ(properties["ignore"]["items"]["items"]["type"], "string");
  EXPECT_EQ(properties["start"]["type"], "object");
  EXPECT_EQ(properties["ceiling"]["type"], "number");
}

TEST(ParamsSchemaTest, ShowsTheDefaults) {
  const json properties = Schema()["properties"];
  EXPECT_EQ(properties["gain"]["default"], 0.5);
  EXPECT_EQ(properties["enabled"]["default"], false);
  EXPECT_EQ(properties["name"]["default"], "\"quoted\"");
  EXPECT_EQ(properties["method"]["default"], "transpose");
  EXPECT_EQ(properties["period"]["default"], 0.01);
  EXPECT_EQ(properties["limit"]["default"], 1.5);
  EXPECT_EQ(properties["weights"]["default"], json::parse("[1, 1]"));
  EXPECT_EQ(properties["waypoints"]["default"], json::parse(R"([{"time": 1, "position": 2}])"));
  EXPECT_EQ(properties["start"]["default"]["position"], 0.125);
  EXPECT_FALSE(properties["count"].contains("default"));  // required
}

TEST(ParamsSchemaTest, DefaultsThatJsonCannotSayAreLeftOut) {
  const json properties = Schema()["properties"];
  for (const char* key : {"ceiling", "reach", "unset"}) {
    EXPECT_FALSE(properties[key].contains("default")) << key;
  }
}

TEST(ParamsSchemaTest, JsonOfFieldsReadsBack) {
  const Everything defaults;
  const json shown = json::parse(JsonOfFields(FieldsOf<Everything>(), &defaults).dump());
  EXPECT_EQ(shown["gain"], 0.5);
  EXPECT_EQ(shown["name"], "\"quoted\"");
  EXPECT_FALSE(shown.contains("reach"));
  EXPECT_FALSE(shown.contains("ceiling"));
  Everything other;
  other.ceiling = 3.0;
  other.limit = PerComponent(Eigen::VectorXd(Eigen::Vector2d(1.0, 0.5)));
  const json more = json::parse(JsonOfFields(FieldsOf<Everything>(), &other).dump());
  EXPECT_EQ(more["ceiling"], 3.0);
  EXPECT_EQ(more["limit"], json::parse("[1, 0.5]"));
}

struct Sampled {
  Period period{1, 10};
  static void Describe(Fields<Sampled>& fields) {
    fields.Add("period", &Sampled::period, "s", "how often").Required().Above(0.0);
  }
};

TEST(ParamsSchemaTest, ARequiredPeriodIsNotRequiredOfTheSchemaBecauseAFrequencyWillDo) {
  const Sampled defaults;
  const json schema = json::parse(SchemaOfFields(FieldsOf<Sampled>(), &defaults).dump());
  EXPECT_FALSE(schema.contains("required"));
  EXPECT_TRUE(schema["properties"].contains("frequency"));
}

TEST(ParamsSchemaTest, EveryTypeHasAName) {
  std::vector<std::string> names;
  for (const Field& field : FieldsOf<Everything>()) names.push_back(field.type->Name());
  EXPECT_THAT(names, testing::ElementsAre(
                         "number", "integer", "true or false", "text", "transpose | damped",
                         "seconds, exact", "number or list", "list of numbers", "list of 3 numbers",
                         "list of {time, position}", "list of list of text", "{time, position}",
                         "number", "number", "number or list"));
}

}  // namespace params_schema_test
}  // namespace oca
