// SPDX-License-Identifier: BSD-3-Clause
// What every system that a file can name has to keep: a test of a ConformanceTest runs for each row
// of the catalogue, so that a new row inherits all.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/signals.h"

namespace oca::runs::conformance {

using nlohmann::ordered_json;

inline systems::ModelSet Models() {
  systems::ModelSet models;
  models.Add("arm", std::make_shared<const robot::RobotModel>(robot::LoadUrdf(
                        files::ResolvePath("package://planar2/planar2.urdf", {}, {}))));
  return models;
}

/// A value of the signal type that every system takes, as JSON: the links of the stretched arm, a
/// default value of other types.
inline std::string Neutral(const SignalType& type, const systems::ModelSet& models) {
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

/// The parameter is the type of a row.
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

/// Of all rows.
inline std::vector<std::string> Types() {
  std::vector<std::string> types;
  const files::Catalogue standard = files::Catalogue::Standard();
  for (const files::Catalogue::Row& row : standard.rows()) types.push_back(row->type);
  return types;
}

}  // namespace oca::runs::conformance
