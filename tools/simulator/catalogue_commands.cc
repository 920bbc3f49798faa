// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/loading/diagram_schema.h"
#include "oca/systems/signals/roles.h"
#include "tools/simulator/catalogue_text.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

template <class Info>
void PrintPorts(const char* kind, const std::vector<Info>& ports) {
  for (const Info& port : ports) {
    Print("  {:<7} {:<22} {}\n", kind, port.name, PortText(port));
  }
}

/// Of type Diagram, whose ports are those of the file.
int DescribeUsedFile() {
  Print("{}: {}\n\n", files::kDiagramType, files::kDiagramSummary);
  Print("ports\n  those that its connections name as inputs.NAME and outputs.NAME\n");
  Print("\nparameters\n");
  for (const files::Section& key : files::DiagramKeys()) {
    Print("  {:<22} {}\n", key.key, key.meaning);
  }
  return kFine;
}

}  // namespace

int ListCommand(const files::Catalogue& catalogue) {
  std::vector<std::pair<std::string, const char*>> types{
      {files::kDiagramType, files::kDiagramSummary}};
  for (const auto& row : catalogue.rows()) types.emplace_back(row->type, row->doc.summary);
  std::sort(types.begin(), types.end());
  std::size_t width = 0;
  for (const auto& type : types) width = std::max(width, type.first.size());
  for (const auto& [type, summary] : types) Print("{:<{}}  {}\n", type, width, summary);
  return kFine;
}

int DescribeCommand(const std::string& type, const files::Catalogue& catalogue) {
  if (type == files::kDiagramType) return DescribeUsedFile();
  const files::CatalogueRow& row = *catalogue.Find(type);
  const auto example = row.MakeExample(ExampleModels());
  Print("{}: {}\n\n  {}\n", row.type, row.doc.summary, row.doc.equation);
  if (*row.doc.source != '\0') Print("  source: {}\n", row.doc.source);
  Print("\nports\n");
  PrintPorts("input", example->inputs());
  PrintPorts("output", example->outputs());
  const auto roles = systems::DescribeRoles(*example);
  if (!roles.empty()) Print("\nroles\n");
  for (const std::string& role : roles) Print("  {}\n", role);
  Print("\nparameters\n");
  const auto defaults = row.new_params();
  for (const Field& field : row.fields()) {
    const std::string usual = field.type->ToJson(field.member(defaults.get())).dump();
    const std::string bounds = field.bounds.ToString();
    Print("  {:<22} {}{}{}; {}\n", field.key, field.type->Name(),
          field.unit.empty() ? "" : " " + field.unit, bounds.empty() ? "" : " " + bounds,
          field.required ? "required" : "default " + usual);
    Print("  {:<22} {}\n", "", field.meaning);
  }
  if (row.fields().empty()) Print("  none\n");
  Print("\nexample parameters\n  {}\n",
        JsonOfFields(row.fields(), row.example_params.get()).dump());
  return kFine;
}

int SchemaCommand(const files::Catalogue& catalogue) {
  WriteData(loading::DiagramSchema(catalogue) + "\n");
  return kFine;
}

}  // namespace oca::tools
