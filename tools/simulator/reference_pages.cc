// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/reference_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/loading/schema_tree.h"
#include "tools/simulator/catalogue_text.h"
#include "tools/simulator/schema_table.h"

namespace oca::tools {
namespace {

using nlohmann::ordered_json;

/// As GitHub names the anchor of a heading that is one word.
std::string Anchor(std::string heading) {
  std::transform(heading.begin(), heading.end(), heading.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return heading;
}

std::string Sentence(std::string text) {
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text + ".";
}

template <class Info>
void AddPortRows(const char* kind, const std::vector<Info>& ports, std::string& page) {
  for (const Info& port : ports) {
    page += fmt::format("| {} | `{}` | {} |\n", kind, port.name, PortText(port));
  }
}

void AddSystemSection(const files::CatalogueRow& row, const systems::ModelSet& models,
                      std::string& page) {
  const auto example = row.MakeExample(models);
  page += fmt::format("\n## {}\n\n{}\n\n    {}\n", row.type, Sentence(row.doc.summary),
                      row.doc.equation);
  if (*row.doc.source != '\0') page += fmt::format("\nSource: {}.\n", row.doc.source);
  page += "\n| | port | carries |\n|---|---|---|\n";
  AddPortRows("input", example->inputs(), page);
  AddPortRows("output", example->outputs(), page);
  const std::string table = SchemaTable(SchemaOfFields(row.fields(), row.new_params().get()));
  page += table.empty() ? "\nNo parameters.\n" : "\n" + table;
  page += fmt::format("\nExample parameters: `{}`\n",
                      JsonOfFields(row.fields(), row.example_params.get()).dump());
}

}  // namespace

std::string SystemsPage(const files::Catalogue& catalogue) {
  std::string page =
      "# Systems\n\n"
      "<!-- Made by `simulator docs systems`; do not edit. -->\n\n"
      "Every type that section `systems` of a diagram file can name. `u` is a unit that follows "
      "from\n"
      "what is connected; a held state is an output that breaks algebraic loops. A number may be\n"
      "given as `\"${...}\"`. The class comment in `systems/` is the whole specification.\n\n"
      "| type | what it does |\n|---|---|\n";
  const systems::ModelSet models = ExampleModels();
  for (const auto& row : catalogue.rows()) {
    page +=
        fmt::format("| [{}](#{}) | {} |\n", row->type, Anchor(row->type), Cell(row->doc.summary));
  }
  page += fmt::format("\nBeside them the type `{}` [{}](diagram_file.md#systems).\n",
                      files::kDiagramType, files::kDiagramSummary);
  for (const auto& row : catalogue.rows()) AddSystemSection(*row, models, page);
  return page;
}

std::string DiagramFilePage(const files::Catalogue& catalogue) {
  std::string page =
      "# The keys of a diagram file\n\n"
      "<!-- Made by `simulator docs diagram_file`; do not edit. -->\n\n"
      "`simulator schema` prints the same for editors. Below, NAME is a name of your choice and "
      "`[]`\n"
      "an item of a list; a number may be given as `\"${...}\"`. How sections are merged, and "
      "what\n"
      "expressions know: [write a diagram](../how-to/write_a_diagram.md).\n";
  const ordered_json schema = loading::DiagramSchemaTree(catalogue);
  for (const files::Section& section : files::Sections()) {
    page += fmt::format("\n## {}\n\n{}\n", section.key, Sentence(section.meaning));
    const ordered_json& keys = schema["properties"][section.key];
    if (std::string(section.key) == "systems") {
      page +=
          "\nEach has `type`, one of [the systems](systems.md), and beside it the parameters of "
          "that\n"
          "type. The type `Diagram` [" +
          std::string(files::kDiagramSummary) + "](../how-to/nest_files.md):\n\n" +
          "| key | meaning |\n|---|---|\n";
      for (const files::Section& key : files::DiagramKeys()) {
        page += fmt::format("| `{}` | {} |\n", key.key, Cell(key.meaning));
      }
      continue;
    }
    const std::string table = SchemaTable(keys);
    if (!table.empty()) page += "\n" + table;
  }
  return page;
}

}  // namespace oca::tools
