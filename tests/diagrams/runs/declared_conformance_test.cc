// SPDX-License-Identifier: BSD-3-Clause
// What every system says of itself, and reads from a file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <set>

#include "oca/diagrams/files/json_reader.h"
#include "oca/diagrams/files/yaml_reader.h"
#include "oca/systems/signals/roles.h"
#include "tests/diagrams/runs/conformance.h"

namespace oca::runs {
namespace declared_conformance_test {

using conformance::Neutral;
using nlohmann::ordered_json;
using testing::HasSubstr;

class DeclaredConformanceTest : public conformance::ConformanceTest {};

bool IsSnakeCase(const std::string& text) {
  return std::regex_match(text, std::regex("[a-z][a-z0-9]*(_[a-z0-9]+)*"));
}

TEST_P(DeclaredConformanceTest, SaysWhatItComputes) {
  EXPECT_GT(std::string(row().doc.summary).size(), 10u);
  EXPECT_FALSE(std::string(row().doc.equation).empty());
  ASSERT_NE(row().doc.source, nullptr);
}

TEST_P(DeclaredConformanceTest, EachParameterHasAKeyOfItsOwnAndAMeaning) {
  std::set<std::string> keys;
  for (const Field& field : row().fields()) {
    EXPECT_TRUE(IsSnakeCase(field.key)) << field.key;
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
    EXPECT_GT(field.meaning.size(), 3u) << field.key;
    EXPECT_NE(field.key, "type");
  }
}

TEST_P(DeclaredConformanceTest, EachPortHasANameOfItsOwn) {
  const auto system = row().MakeExample(models_);
  std::set<std::string> inputs, outputs;
  for (const auto& input : system->inputs()) {
    EXPECT_TRUE(IsSnakeCase(input.name)) << input.name;
    EXPECT_TRUE(inputs.insert(input.name).second) << input.name;
  }
  for (const auto& output : system->outputs()) {
    EXPECT_TRUE(IsSnakeCase(output.name)) << output.name;
    EXPECT_TRUE(outputs.insert(output.name).second) << output.name;
  }
  EXPECT_GT(inputs.size() + outputs.size(), 0u);
}

TEST_P(DeclaredConformanceTest, EveryLimitIsShownByASignalThatCanShowIt) {
  const auto system = row().MakeExample(models_);
  for (const auto* limits : system->roles<systems::Limits>()) {
    const OutputHandle& output = limits->signal.output;
    if (output.system == nullptr) {
      EXPECT_EQ(limits->signal.input.system, system.get());
      continue;
    }
    ASSERT_EQ(output.system, system.get());
    const bool listed = limits->shown == systems::Limits::Shown::kListed;
    EXPECT_NE(listed, !limits->bound.empty());
    if (&TypeOfPort(output) == &kVectorType) {
      EXPECT_TRUE(limits->member.empty());
      continue;
    }
    // As the record has it: a list is an object with the port's name.
    auto value = ordered_json::parse(Neutral(TypeOfPort(output), models_));
    if (value.is_array()) value = {{system->outputs()[output.index].name, value}};
    ASSERT_TRUE(value.contains(limits->member)) << value;
    EXPECT_EQ(value[limits->member].is_array(), listed);
  }
}

TEST_P(DeclaredConformanceTest, ReadsItsOwnExample) {
  Problems problems;
  const auto system =
      row().Make(files::ReadJson(Example().dump(), "example"), "here", models_, problems);
  EXPECT_THAT(problems.all(), testing::IsEmpty());
  ASSERT_NE(system, nullptr);
  const auto example = row().MakeExample(models_);
  EXPECT_EQ(system->inputs().size(), example->inputs().size());
  EXPECT_EQ(system->outputs().size(), example->outputs().size());
}

TEST_P(DeclaredConformanceTest, RefusesAnUnknownKeyAtItsPlace) {
  auto example = Example();
  example["no_such_key"] = 1;
  Problems problems;
  const Value value = files::ReadYaml(example.dump(), "f.yaml", problems);
  ASSERT_TRUE(problems.empty());
  EXPECT_EQ(row().Make(value, "systems.it", models_, problems), nullptr);
  ASSERT_EQ(problems.all().size(), 1u);
  EXPECT_THAT(problems.all().front().ToString(), testing::StartsWith("f.yaml:1:"));
  EXPECT_THAT(problems.all().front().ToString(), HasSubstr("systems.it.no_such_key: unknown key"));
}

TEST_P(DeclaredConformanceTest, RefusesEveryParameterOfTheWrongType) {
  for (const Field& field : row().fields()) {
    auto example = Example();
    example[field.key] = {{"no_such", {{"thing", true}}}};
    Problems problems;
    EXPECT_EQ(row().Make(files::ReadJson(example.dump(), "f"), "it", models_, problems), nullptr)
        << field.key;
    ASSERT_FALSE(problems.empty()) << field.key;
    EXPECT_THAT(problems.all().front().ToString(), HasSubstr("it." + field.key));
  }
}

/// Sets a number of a field of a struct; false if it has none.
bool SetNumber(const Field& field, void* params, double number) {
  void* const member = field.member(params);
  if (field.type == &ParamTypeOf<double>()) {
    *static_cast<double*>(member) = number;
  } else if (field.type == &ParamTypeOf<std::optional<double>>()) {
    *static_cast<std::optional<double>*>(member) = number;
  } else if (field.type == &ParamTypeOf<int>()) {
    *static_cast<int*>(member) = static_cast<int>(number);
  } else if (field.type == &ParamTypeOf<PerComponent>()) {
    *static_cast<PerComponent*>(member) = number;
  } else if (field.type == &ParamTypeOf<Period>()) {
    *static_cast<Period*>(member) = Period::FromSeconds(number);
  } else {
    return false;
  }
  return true;
}

TEST_P(DeclaredConformanceTest, MadeInCppItRefusesWhatFilesMayNotSay) {
  const std::shared_ptr<void> defaults = row().new_params();
  for (const Field& field : row().fields()) {
    std::vector<double> bad;
    const Bounds& bounds = field.bounds;
    if (std::isfinite(bounds.lower)) bad.push_back(bounds.above ? bounds.lower : bounds.lower - 1);
    if (std::isfinite(bounds.upper)) bad.push_back(bounds.upper + 1);
    for (const double number : bad) {
      // A copy of the example, made as a file's would be.
      const std::shared_ptr<void> params = row().new_params();
      Problems problems;
      ReadFields(files::ReadJson(Example().dump(), "example"), row().fields(), "", params.get(),
                 problems);
      ASSERT_TRUE(problems.empty());
      const bool usual =
          !field.required && field.type->ToJson(field.member(defaults.get())) == number;
      if (usual || !SetNumber(field, params.get(), number)) continue;
      try {
        row().build(params.get(), models_);
        ADD_FAILURE() << field.key << ": " << number << " was taken";
      } catch (const ConfigError& error) {
        EXPECT_THAT(error.what(), HasSubstr(field.key + ": got ")) << number;
      }
    }
  }
}

TEST_P(DeclaredConformanceTest, ItsSchemaNamesEveryParameter) {
  const auto schema = SchemaOfFields(row().fields(), row().new_params().get());
  for (const Field& field : row().fields()) {
    ASSERT_TRUE(schema.at("properties").contains(field.key)) << field.key;
    EXPECT_TRUE(schema["properties"][field.key].contains("description")) << field.key;
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, DeclaredConformanceTest,
                         testing::ValuesIn(conformance::Types()),
                         [](const auto& type) { return type.param; });

}  // namespace declared_conformance_test
}  // namespace oca::runs
