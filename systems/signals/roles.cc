// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/roles.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/diagram.h"

namespace oca::systems {
namespace {

std::string PortText(const OutputHandle& output) {
  return "`" + output.system->outputs()[static_cast<std::size_t>(output.index)].name + "`";
}

std::string PortText(const InputHandle& input) {
  return "`" + input.system->inputs()[static_cast<std::size_t>(input.index)].name + "`";
}

std::string PortText(const RolePort& port) {
  return port.output.system != nullptr ? PortText(port.output)
                                       : "what drives " + PortText(port.input);
}

}  // namespace

std::optional<OutputHandle> RolePort::In(const Diagram& diagram) const {
  if (output.system != nullptr) return output;
  if (input.system == nullptr) return std::nullopt;
  return diagram.DriverOf(input);
}

std::vector<std::string> DescribeRoles(const System& system) {
  std::vector<std::string> texts;
  const auto each = [&]<class Role>(std::string (*text_of)(const Role&)) {
    for (const Role* role : system.roles<Role>()) texts.push_back(text_of(*role));
  };
  each(+[](const Limits& role) { return "limits, as " + PortText(role.signal) + " shows"; });
  each(+[](const Judges& role) { return "judges a run: " + PortText(role.metrics); });
  each(+[](const Boundary& role) {
    return fmt::format("stands for {}, whose place a robot's own loop takes", role.stands_for);
  });
  each(+[](const Plant& role) {
    return "moves joints by " + PortText(role.command) + ": " + PortText(role.position);
  });
  each(+[](const HoldsObstacles& role) {
    return "says where obstacles really are: " + PortText(role.obstacles);
  });
  each(+[](const Kinematics& role) {
    return "places the links of a robot: " + PortText(role.links);
  });
  each(+[](const MeasuresDistances& role) {
    return "measures distances: " + PortText(role.proximities);
  });
  each(+[](const BlindSpots&) { return std::string("knows what is not seen"); });
  each(+[](const KnowsWhatBlocks&) {
    return std::string("knows what keeps its robot from its goal");
  });
  each(+[](const Repels& role) { return fmt::format("pushes links up to {} m away", role.range); });
  each(+[](const Plots& role) {
    return fmt::format("plots {} ({})", PortText(role.signal), role.title);
  });
  each(+[](const NotDrawn& role) { return PortText(role.output) + " is not drawn"; });
  each(+[](const PassesOn& role) { return PortText(role.out) + " shows " + PortText(role.in); });
  each(
      +[](const Remarks&) { return std::string("may have remarks when it is loaded or checked"); });
  each(+[](const MapsForces& role) { return "maps forces to a delta: " + PortText(role.delta); });
  each(+[](const CarriesDelta& role) {
    return "a delta passes from " + PortText(role.in) + " to " + PortText(role.out);
  });
  each(+[](const AddsDelta& role) { return "adds " + PortText(role.delta) + " to the request"; });
  return texts;
}

}  // namespace oca::systems
