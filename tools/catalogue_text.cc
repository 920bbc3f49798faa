// SPDX-License-Identifier: BSD-3-Clause
#include "tools/catalogue_text.h"

#include <fmt/format.h>

#include "diagrams/package_paths.h"
#include "models/robot/urdf.h"

namespace oca::tools {
namespace {

std::string UnitText(const Unit& unit) {
  if (unit.any()) return "any unit";
  std::string text = unit.variable() >= 0 ? "u" : unit.text();
  if (unit.rates() == 0) return text;
  return unit.rates() == 1 ? text + "/s" : fmt::format("{}/s^{}", text, unit.rates());
}

template <class Info>
std::string TypeAndUnit(const Info& port) {
  std::string text = port.type->name;
  return port.type == &kVectorType ? text + ", " + UnitText(port.spec.unit) : text;
}

}  // namespace

std::string PortText(const System::InputInfo& port) {
  return TypeAndUnit(port) + (port.optional ? ", optional" : "");
}

std::string PortText(const System::OutputInfo& port) {
  return TypeAndUnit(port) + (port.state >= 0 ? ", held state" : "");
}

systems::ModelSet ExampleModels() {
  systems::ModelSet models;
  models.Add("arm", std::make_shared<const models::RobotModel>(models::LoadUrdf(
                        diagrams::ResolvePath("package://planar2/planar2.urdf", {}, {}))));
  return models;
}

}  // namespace oca::tools
