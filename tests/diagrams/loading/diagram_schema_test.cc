// SPDX-License-Identifier: BSD-3-Clause
// What JSON Schema itself demands of a schema, which editors check first.
#include "oca/diagrams/loading/diagram_schema.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace oca::loading {
namespace {

using nlohmann::json;

const std::set<std::string> kTypes{"array",  "boolean", "integer", "null",
                                   "number", "object",  "string"};

/// A type is one of the names, or a list of different ones: draft 7, section 6.1.1.
void ExpectTypes(const json& type, const std::string& where) {
  std::set<std::string> seen;
  for (const json& name : type.is_array() ? type : json::array({type})) {
    ASSERT_TRUE(name.is_string()) << where;
    EXPECT_EQ(kTypes.count(name), 1) << where << ": " << name;
    EXPECT_TRUE(seen.insert(name).second) << where << ": " << name << " twice";
  }
}

void ExpectSchema(const json& schema, const std::string& where) {
  if (schema.is_boolean()) return;
  ASSERT_TRUE(schema.is_object()) << where;
  if (schema.contains("type")) ExpectTypes(schema["type"], where);
  for (const char* key : {"items", "additionalProperties", "if", "then", "else", "not"}) {
    if (schema.contains(key)) ExpectSchema(schema[key], where + "/" + key);
  }
  for (const char* key : {"properties", "definitions", "patternProperties"}) {
    if (!schema.contains(key)) continue;
    for (const auto& [name, part] : schema[key].items()) {
      ExpectSchema(part, where + "/" + key + "/" + name);
    }
  }
  for (const char* key : {"anyOf", "allOf", "oneOf"}) {
    if (!schema.contains(key)) continue;
    for (const json& part : schema[key]) ExpectSchema(part, where + "/" + key);
  }
}

TEST(DiagramSchema, IsASchema) {
  const json schema = json::parse(DiagramSchema());
  EXPECT_GT(schema.at("properties").size(), 5);
  ExpectSchema(schema, "");
}

TEST(DiagramSchema, ArgumentsOfAXacroAreAnyTextNumberOrBoolean) {
  const json arguments =
      json::parse(DiagramSchema())
          .at("/properties/models/additionalProperties/properties/arguments"_json_pointer);
  EXPECT_EQ(arguments.at("additionalProperties"),
            (json{{"type", {"string", "number", "boolean"}}}));
}

}  // namespace
}  // namespace oca::loading
