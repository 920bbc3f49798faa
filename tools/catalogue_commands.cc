// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "diagrams/catalogue.h"
#include "diagrams/diagram_file.h"
#include "diagrams/package_paths.h"
#include "models/robot/urdf.h"
#include "systems/roles.h"
#include "tools/commands.h"
#include "tools/terminal.h"

namespace oca::tools {
namespace {

template <class Info>
void PrintPorts(const char* kind, const std::vector<Info>& ports) {
  for (const Info& port : ports) {
    std::string text = port.type->name;
    if (port.type == &kVectorType) {
      text += ", " + (port.spec.unit.any() ? "any unit" : port.spec.unit.ToString());
    }
    if constexpr (requires { port.optional; }) {
      if (port.optional) text += ", optional";
    }
    if constexpr (requires { port.state; }) {
      if (port.state >= 0) text += ", held state";
    }
    Print("  {:<7} {:<22} {}\n", kind, port.name, text);
  }
}

systems::ModelSet ExampleModels() {
  systems::ModelSet models;
  models.Add("arm", std::make_shared<const models::RobotModel>(models::LoadUrdf(
                        diagrams::ResolvePath("package://planar2/planar2.urdf", {}, {}))));
  return models;
}

}  // namespace

int ListCommand() {
  std::size_t width = 0;
  for (const auto& row : diagrams::Catalogue()) width = std::max(width, row.type.size());
  for (const auto& row : diagrams::Catalogue()) {
    Print("{:<{}}  {}\n", row.type, width, row.doc.summary);
  }
  return kFine;
}

int DescribeCommand(const std::string& type) {
  const diagrams::CatalogueRow& row = diagrams::FindRow(type);
  const auto example = row.make_example(ExampleModels());
  Print("{}: {}\n\n  {}\n", row.type, row.doc.summary, row.doc.equation);
  if (*row.doc.source != '\0') Print("  source: {}\n", row.doc.source);
  Print("\nports\n");
  PrintPorts("input", example->inputs());
  PrintPorts("output", example->outputs());
  const auto roles = systems::DescribeRoles(*example);
  if (!roles.empty()) Print("\nroles\n");
  for (const std::string& role : roles) Print("  {}\n", role);
  Print("\nparameters\n");
  const auto defaults = row.defaults();
  for (std::size_t i = 0; i < row.fields().size(); ++i) {
    const Field& field = row.fields()[i];
    const std::string bounds = field.bounds.ToString();
    Print("  {:<22} {}{}{}; {}\n", field.key, field.type->Name(),
          field.unit.empty() ? "" : " " + field.unit, bounds.empty() ? "" : " " + bounds,
          field.required ? "required" : "default " + defaults[i]);
    Print("  {:<22} {}\n", "", field.meaning);
  }
  if (row.fields().empty()) Print("  none\n");
  Print("\nexample parameters\n  {}\n", row.example());
  return kFine;
}

int SchemaCommand() {
  std::cout << diagrams::DiagramSchema() << '\n';
  return kFine;
}

}  // namespace oca::tools
