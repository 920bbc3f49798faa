// SPDX-License-Identifier: BSD-3-Clause
// What every system that a file can name has to keep; a new row of the catalogue inherits it all.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <set>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/json_reader.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/files/yaml_reader.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"
#include "oca/systems/signals/signals.h"
#include "tests/allocation_count.h"

namespace oca::runs {
namespace conformance_test {

using nlohmann::ordered_json;
using testing::HasSubstr;

systems::ModelSet Models() {
  systems::ModelSet models;
  models.Add("arm", std::make_shared<const robot::RobotModel>(robot::LoadUrdf(
                        files::ResolvePath("package://planar2/planar2.urdf", {}, {}))));
  return models;
}

bool IsSnakeCase(const std::string& text) {
  return std::regex_match(text, std::regex("[a-z][a-z0-9]*(_[a-z0-9]+)*"));
}

/// A value of the signal type that every system takes, as JSON: the links of the stretched arm, a
/// default value of other types.
std::string Neutral(const SignalType& type, const systems::ModelSet& models) {
  if (&type == &TypeOf<systems::LinkPoses>()) {
    const robot::RobotModel& arm = *models.Get("arm");
    systems::LinkPoses links;
    systems::NameLinks(arm, links);
    links.poses = robot::LinkPoses(arm, Eigen::VectorXd::Zero(arm.num_positions()));
    std::string text;
    Signal<systems::LinkPoses>::WriteJson(links, text);
    return text;
  }
  return DefaultJson(type);
}

class ConformanceTest : public testing::TestWithParam<std::string> {
 protected:
  const files::CatalogueRow& row() const { return *catalogue_.Find(GetParam()); }

  /// The parameters of the example.
  ordered_json Example() const { return JsonOfFields(row().fields(), row().example_params.get()); }

  /// The example in a diagram of its own. Vectors of open length get two elements.
  std::unique_ptr<Diagram> MakeDiagram() const {
    try {
      return MakeDiagramOf(row().MakeExample(models_));
    } catch (const WiringError&) {
      std::map<std::string, int> sizes;
      const auto probe = row().MakeExample(models_);
      for (const auto& input : probe->inputs()) {
        if (!input.optional) sizes[input.name] = input.type == &kVectorType ? 2 : -1;
      }
      return MakeDiagramOf(row().MakeExample(models_), sizes);
    }
  }

  /// Zeros for vectors, whatever their length, and neutral values of other types; for all inputs
  /// but one, if named.
  void FixInputs(const Diagram& diagram, Context& context, const std::string& but = "") const {
    for (const auto& input : diagram.inputs()) {
      if (input.name == but) continue;
      if (input.type != &kVectorType) {
        FixJson(diagram.FindInput(input.name), context, Neutral(*input.type, models_));
        continue;
      }
      bool fixed = false;
      for (int size = 1; size <= 12 && !fixed; ++size) {
        try {
          FixJson(diagram.FindInput(input.name), context,
                  ordered_json(std::vector(size, 0)).dump());
          fixed = true;
        } catch (const Error&) {
        }
      }
      EXPECT_TRUE(fixed) << input.name;
    }
  }

  /// All outputs as JSON; of one that fails, why.
  static std::string Outputs(const Diagram& diagram, const Context& context) {
    std::string text;
    for (const auto& output : diagram.outputs()) {
      text += output.name + "=";
      try {
        EvalJson(diagram.FindOutput(output.name), context, text);
      } catch (const SimulationError& error) {
        EXPECT_FALSE(std::string(error.what()).empty());
        text += error.what();
      }
      text += "\n";
    }
    return text;
  }

  const files::Catalogue catalogue_ = files::Catalogue::Standard();
  const systems::ModelSet models_ = Models();
};

TEST_P(ConformanceTest, SaysWhatItComputes) {
  EXPECT_GT(std::string(row().doc.summary).size(), 10u);
  EXPECT_FALSE(std::string(row().doc.equation).empty());
  ASSERT_NE(row().doc.source, nullptr);
}

TEST_P(ConformanceTest, EachParameterHasAKeyOfItsOwnAndAMeaning) {
  std::set<std::string> keys;
  for (const Field& field : row().fields()) {
    EXPECT_TRUE(IsSnakeCase(field.key)) << field.key;
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
    EXPECT_GT(field.meaning.size(), 3u) << field.key;
    EXPECT_NE(field.key, "type");
  }
}

TEST_P(ConformanceTest, EachPortHasANameOfItsOwn) {
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

TEST_P(ConformanceTest, EveryLimitIsShownByASignalThatCanShowIt) {
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

TEST_P(ConformanceTest, ReadsItsOwnExample) {
  Problems problems;
  const auto system =
      row().Make(files::ReadJson(Example().dump(), "example"), "here", models_, problems);
  EXPECT_THAT(problems.all(), testing::IsEmpty());
  ASSERT_NE(system, nullptr);
  const auto example = row().MakeExample(models_);
  EXPECT_EQ(system->inputs().size(), example->inputs().size());
  EXPECT_EQ(system->outputs().size(), example->outputs().size());
}

TEST_P(ConformanceTest, RefusesAnUnknownKeyAtItsPlace) {
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

TEST_P(ConformanceTest, RefusesEveryParameterOfTheWrongType) {
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

TEST_P(ConformanceTest, MadeInCppItRefusesWhatFilesMayNotSay) {
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

TEST_P(ConformanceTest, ItsSchemaNamesEveryParameter) {
  const auto schema = SchemaOfFields(row().fields(), row().new_params().get());
  for (const Field& field : row().fields()) {
    ASSERT_TRUE(schema.at("properties").contains(field.key)) << field.key;
    EXPECT_TRUE(schema["properties"][field.key].contains("description")) << field.key;
  }
}

TEST_P(ConformanceTest, EvaluatesToTheSameBitsEachTimeAndInACopy) {
  const auto diagram = MakeDiagram();
  Context context = diagram->MakeContext();
  FixInputs(*diagram, context);
  const Context copy = context;
  const std::string first = Outputs(*diagram, context);
  EXPECT_EQ(Outputs(*diagram, context), first);
  EXPECT_EQ(Outputs(*diagram, copy), first);
  EXPECT_THAT(first, testing::Not(HasSubstr("nan")));
}

TEST_P(ConformanceTest, RunsToTheSameBitsTwice) {
  const auto diagram = MakeDiagram();
  const auto run = [&] {
    Simulator simulator(*diagram);
    FixInputs(*diagram, simulator.context());
    try {
      simulator.AdvanceTo(0.5);
    } catch (const SimulationError& error) {
      return std::string(error.what());
    }
    return Outputs(*diagram, simulator.context());
  };
  EXPECT_EQ(run(), run());
}

TEST_P(ConformanceTest, ItsInputsRefuseWhatIsNotFinite) {
  const auto diagram = MakeDiagram();
  Context context = diagram->MakeContext();
  FixInputs(*diagram, context);
  for (const auto& input : diagram->inputs()) {
    if (input.type != &kVectorType) continue;
    const auto port = diagram->GetInput<Vector>(input.name);
    for (int size = 1; size <= 12; ++size) {
      for (const double bad :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const Eigen::VectorXd value = Eigen::VectorXd::Constant(size, bad);
        EXPECT_ANY_THROW(port.Fix(context, value)) << input.name << " " << size;
      }
    }
  }
}

TEST_P(ConformanceTest, AnInputThatNobodyFixedIsNeverReadAsZero) {
  const auto diagram = MakeDiagram();
  for (const auto& input : diagram->inputs()) {
    Simulator simulator(*diagram);
    FixInputs(*diagram, simulator.context(), input.name);
    try {
      simulator.Initialize();
      ADD_FAILURE() << input.name << " was read";
    } catch (const SimulationError& error) {
      EXPECT_EQ(error.port, input.name);
      EXPECT_THAT(error.what(), HasSubstr("has not been fixed"));
    }
  }
}

TEST_P(ConformanceTest, NoOutputThatReadsAnInputHasAValueBeforeItIsFixed) {
  const auto diagram = MakeDiagram();
  const Context context = diagram->MakeContext();
  for (const auto& output : diagram->outputs()) {
    const OutputHandle port = diagram->FindOutput(output.name);
    for (const InputHandle& input : diagram->UpstreamOf(port, Through::kInstant).exported) {
      if (diagram->inputs()[input.index].optional) continue;
      std::string text;
      EXPECT_THROW(EvalJson(port, context, text), SimulationError) << output.name << " is " << text;
    }
  }
}

TEST_P(ConformanceTest, RunsWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const auto diagram = MakeDiagram();
  Simulator simulator(*diagram);
  FixInputs(*diagram, simulator.context());
  simulator.Initialize();
  const std::int64_t before = AllocationCount();
  simulator.AdvanceTo(0.4);
  EXPECT_EQ(AllocationCount(), before);
}

std::vector<std::string> Types() {
  std::vector<std::string> types;
  const files::Catalogue standard = files::Catalogue::Standard();
  for (const files::Catalogue::Row& row : standard.rows()) types.push_back(row->type);
  return types;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, ConformanceTest, testing::ValuesIn(Types()),
                         [](const auto& type) { return type.param; });

}  // namespace conformance_test
}  // namespace oca::runs
