// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/catalogue_text.h"

#include <fmt/format.h>

#include "oca/diagrams/files/package_paths.h"
#include "oca/models/robot/urdf.h"

namespace oca::tools {
namespace {

template <class Info>
std::string TypeAndUnit(const Info& port) {
  std::string text = port.type->name;
  return port.type == &kVectorType
             ? text + ", " + (port.spec.unit.any() ? "any unit" : port.spec.unit.ToString())
             : text;
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
  models.Add("arm", std::make_shared<const robot::RobotModel>(robot::LoadUrdf(
                        files::ResolvePath("package://planar2/planar2.urdf", {}, {}))));
  return models;
}

}  // namespace oca::tools
