// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/diagram_schema.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/run_params.h"
#include "oca/diagrams/loading/schema_tree.h"
#include "oca/diagrams/sampling/scenario.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::loading {
namespace {

using nlohmann::ordered_json;

ordered_json SchemaOf(const ParamType& type) { return type.Schema({}); }

ordered_json MapOf(const ordered_json& items) {
  return {{"type", "object"}, {"additionalProperties", items}};
}

bool TakesText(const ordered_json& type) {
  return type == "string" ||
         (type.is_array() && std::find(type.begin(), type.end(), "string") != type.end());
}

/// What is no text may also be given as "${...}". Said beside the type, not as an alternative, so
/// that an editor says of a wrong number what is wrong with it.
void AllowExpressions(ordered_json& schema) {
  for (const char* key : {"items", "additionalProperties"}) {
    if (schema.contains(key) && schema[key].is_object()) AllowExpressions(schema[key]);
  }
  if (schema.contains("properties")) {
    for (auto& [key, property] : schema["properties"].items()) AllowExpressions(property);
  }
  const char* const expression = "\\$\\{.*\\}";
  if (schema.contains("enum")) {
    ordered_json names{{"enum", schema["enum"]}};
    schema.erase("enum");
    schema["anyOf"] =
        ordered_json::array({std::move(names), {{"type", "string"}, {"pattern", expression}}});
  } else if (schema.contains("type") && schema["type"] != "object" && !TakesText(schema["type"])) {
    if (!schema["type"].is_array()) schema["type"] = ordered_json::array({schema["type"]});
    schema["type"].push_back("string");
    schema["pattern"] = expression;
  }
}

/// Nothing is required of maps: what is missing here may stand in a file that includes this one or
/// is included by it, for maps are merged key by key. Lists are not, so what they hold is whole.
void AllowPartialMaps(ordered_json& schema) {
  schema.erase("required");
  if (schema.contains("additionalProperties") && schema["additionalProperties"].is_object()) {
    AllowPartialMaps(schema["additionalProperties"]);
  }
  if (!schema.contains("properties")) return;
  for (auto& [key, property] : schema["properties"].items()) AllowPartialMaps(property);
}

/// Of the parts of a diagram that maps hold.
ordered_json PartialSchemaOf(ordered_json schema) {
  AllowExpressions(schema);
  AllowPartialMaps(schema);
  return schema;
}

ordered_json IfType(const std::string& type, const ordered_json& then) {
  const ordered_json condition{{"required", {"type"}},
                               {"properties", {{"type", {{"const", type}}}}}};
  return {{"if", condition}, {"then", then}};
}

/// A file as a system.
ordered_json UsedFileSchema() {
  ordered_json properties;
  properties["file"] = {{"type", "string"}};
  properties["parameters"] = {{"type", {"object", "array", "string"}},
                              {"items", {{"type", {"object", "string"}}}},
                              {"pattern", "\\$\\{.*\\}"}};
  properties["models"] = MapOf({{"type", "string"}});
  for (const files::Section& key : files::DiagramKeys()) {
    properties[key.key]["description"] = key.meaning;
  }
  return {{"type", "object"},
          {"properties", properties},
          {"required", {"file"}},
          {"additionalProperties", false}};
}

/// The system that is named by `type`; where an included file names it, any key of any system.
ordered_json SystemsSchema(const files::Catalogue& catalogue) {
  ordered_json types = ordered_json::array();
  ordered_json cases = ordered_json::array();
  ordered_json known = ordered_json::object();  // key -> what it is in one system or another
  const auto add = [&](const std::string& type, const char* summary, ordered_json schema) {
    types.push_back(type);
    for (const auto& [key, property] : schema["properties"].items()) {
      ordered_json& variants = known[key]["anyOf"];
      if (std::find(variants.begin(), variants.end(), property) == variants.end()) {
        variants.push_back(property);
      }
    }
    schema["properties"]["type"] = {{"const", type}, {"description", summary}};
    schema["description"] = summary;
    cases.push_back(IfType(type, schema));
  };
  for (const files::Catalogue::Row& row : catalogue.rows()) {
    add(row->type, row->doc.summary,
        PartialSchemaOf(SchemaOfFields(row->fields(), row->new_params().get())));
  }
  ordered_json used_file = UsedFileSchema();
  AllowPartialMaps(used_file);
  add(files::kDiagramType, files::kDiagramSummary, std::move(used_file));
  cases.push_back({{"if", {{"not", {{"required", {"type"}}}}}},
                   {"then", {{"properties", known}, {"additionalProperties", false}}}});
  return MapOf(
      {{"type", "object"}, {"properties", {{"type", {{"enum", types}}}}}, {"allOf", cases}});
}

/// What a file with a name that includes nothing must say: it is whole.
ordered_json WholeFileSchema(const files::Catalogue& catalogue) {
  ordered_json cases = ordered_json::array();
  for (const files::Catalogue::Row& row : catalogue.rows()) {
    const ordered_json schema = SchemaOfFields(row->fields(), row->new_params().get());
    if (!schema.contains("required")) continue;
    cases.push_back(IfType(row->type, {{"required", schema["required"]}}));
  }
  cases.push_back(IfType(files::kDiagramType, {{"required", UsedFileSchema()["required"]}}));
  const ordered_json systems = MapOf({{"required", {"type"}}, {"allOf", cases}});
  const auto needs = [](const char* key) -> ordered_json { return {{"required", {key}}}; };
  const ordered_json models =
      MapOf({{"oneOf", ordered_json::array({needs("urdf"), needs("xacro")})}});
  return {{"properties", {{"systems", systems}, {"models", models}}}};
}

}  // namespace

ordered_json DiagramSchemaTree(const files::Catalogue& catalogue) {
  ordered_json sections;
  const ordered_json text{{"type", "string"}};
  sections["name"] = text;
  sections["description"] = text;
  sections["include"] = {{"type", "array"}, {"items", text}};
  sections["parameters"] = {{"type", "object"}};
  sections["simulator"] = PartialSchemaOf(SchemaOf(ParamTypeOf<files::SimulatorParams>()));
  sections["simulator_tolerances"] = PartialSchemaOf(MapOf(SchemaOf(ParamTypeOf<Tolerances>())));
  sections["sampling"] = PartialSchemaOf(sampling::SamplingSchema());
  sections["packages"] = MapOf(text);
  sections["models"] = PartialSchemaOf(MapOf(SchemaOf(ParamTypeOf<files::ModelParams>())));
  sections["systems"] = SystemsSchema(catalogue);
  const char* const arrow = "^\\S+ *-> *\\S+$|^\\$\\{.*\\}$";  // or an expression that is one
  sections["connections"] = {{"type", "array"},
                             {"items", {{"type", "string"}, {"pattern", arrow}}}};
  const auto rate = [](const char* meaning) -> ordered_json {
    return {
        {"type", "number"}, {"exclusiveMinimum", 0}, {"description", meaning}, {"x-unit", "Hz"}};
  };
  ordered_json signals = MapOf(rate("of `system.port`, or of all that `system.*` names"));
  signals["description"] = "signals and how often to keep them";
  sections["record"] = PartialSchemaOf(
      {{"type", "object"},
       {"additionalProperties", false},
       {"properties",
        {{"signals", signals}, {"scene", rate("of the scene that report and view show")}}}});
  sections["expect"] = PartialSchemaOf(MapOf(SchemaOf(ParamTypeOf<files::ExpectParams>())));
  for (const files::Section& section : files::Sections())
    sections[section.key]["description"] = section.meaning;
  const ordered_json whole{{"required", {"name"}}, {"not", {{"required", {"include"}}}}};
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", "OCA diagram"},
          {"type", "object"},
          {"additionalProperties", false},
          {"properties", sections},
          {"if", whole},
          {"then", WholeFileSchema(catalogue)}};
}

std::string DiagramSchema(const files::Catalogue& catalogue) {
  return oca::internal::JsonText(DiagramSchemaTree(catalogue), 2);
}

}  // namespace oca::loading
