// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/diagram_file.h"

#include <nlohmann/json.hpp>

#include "diagrams/sampling/scenario.h"

namespace oca::diagrams {

using nlohmann::ordered_json;

void SimulatorParams::Describe(Fields<SimulatorParams>& fields) {
  fields.Add("duration", &SimulatorParams::duration, "s", "how long to run")
      .AtLeast(0.0)
      .AtMost(1e7);
  fields.Include(&SimulatorParams::integration);
  fields
      .Add("realtime_factor", &SimulatorParams::realtime_factor, "",
           "simulated seconds to a second of the wall clock; 0 runs as fast as possible")
      .AtLeast(0.0);
  fields.Add("seed", &SimulatorParams::seed, "", "of everything random in the run").AtLeast(0.0);
}

void AttachedParams::Describe(Fields<AttachedParams>& fields) {
  fields.Add("id", &AttachedParams::id, "", "its name, as a link of the robot").Required();
  fields.Add("link", &AttachedParams::link, "", "link that carries it").Required();
  fields.Add("shape", &AttachedParams::shape, "", "its solid").Required();
  fields.Add("pose", &AttachedParams::pose, "", "of the shape in the frame of that link");
  fields.Add("touches", &AttachedParams::touches, "",
             "links of the robot that it may touch, besides those rigidly connected to it");
}

void ModelParams::Describe(Fields<ModelParams>& fields) {
  fields.Add("urdf", &ModelParams::urdf, "", "robot description: a path or package://NAME/PATH")
      .Required();
  fields.Add("srdf", &ModelParams::srdf, "", "pairs of links that are not checked for collision");
  fields.Add("collision", &ModelParams::collision, "",
             "what its collision meshes count as: their convex hull, or the convex parts of a "
             "decomposition, which keep hollows");
  fields.Add("visual_as_collision", &ModelParams::visual_as_collision, "",
             "which links take what is drawn of them as their collision shapes: none, those that "
             "are missing any, or all that are drawn");
  fields.Add("base_pose", &ModelParams::base_pose, "", "pose of the root link in the world");
  fields
      .Add("acceleration_limits", &ModelParams::acceleration_limits, "rad/s^2",
           "which URDF lacks; a number or one a joint")
      .Above(0.0);
  fields
      .Add("jerk_limits", &ModelParams::jerk_limits, "rad/s^3",
           "which URDF lacks; a number or one a joint")
      .Above(0.0);
  fields.Add("attached", &ModelParams::attached, "",
             "tools and grasped objects: they move with a link of the robot and collide");
}

void ExpectParams::Describe(Fields<ExpectParams>& fields) {
  fields.Add("at_least", &ExpectParams::at_least, "", "lower bound");
  fields.Add("at_most", &ExpectParams::at_most, "", "upper bound");
  fields.Add("equal", &ExpectParams::equal, "", "value, give or take `within`");
  fields.Add("within", &ExpectParams::within, "", "distance from `equal` that is allowed")
      .AtLeast(0.0);
  fields.Add("at", &ExpectParams::at, "s", "when to look; the end of the run if left out")
      .AtLeast(0.0);
}

const std::vector<Section>& Sections() {
  static const std::vector<Section> sections = {
      {"name", "short name of the diagram"},
      {"description", "what it shows, in a sentence"},
      {"include", "files to merge first; this file wins"},
      {"parameters", "knobs of this file, used as ${name}"},
      {"simulator", "duration, integrator, tolerances, seed"},
      {"simulator_tolerances", "tolerances of single systems, by name"},
      {"sampling",
       "makes the file a family of scenarios: what the seed draws, and what is accepted"},
      {"packages", "folders that package://NAME/ stands for"},
      {"models", "robots and frames, by name"},
      {"systems", "blocks, by name: type and parameters"},
      {"connections", "list of `system.output -> system.input`"},
      {"record", "signals to keep, with their rates in Hz"},
      {"expect", "bounds on metrics and signals that the run must keep"},
  };
  return sections;
}

namespace {

ordered_json SchemaOf(const ParamType& type) { return type.Schema({}); }

ordered_json MapOf(const ordered_json& items) {
  return {{"type", "object"}, {"additionalProperties", items}};
}

/// Numbers and booleans may also be given as "${...}".
void AllowExpressions(ordered_json& schema) {
  if (schema.is_array()) {
    for (auto& item : schema) AllowExpressions(item);
    return;
  }
  if (!schema.is_object()) return;
  for (auto& [key, item] : schema.items()) {
    if (key != "default" && key != "enum") AllowExpressions(item);
  }
  const auto type = schema.find("type");
  const bool plain = type != schema.end() && (*type == "number" || *type == "integer" ||
                                              *type == "boolean" || *type == "array");
  if (!plain && !schema.contains("enum")) return;
  ordered_json description;
  if (schema.contains("description")) description = schema["description"];
  const ordered_json expression{{"type", "string"}, {"pattern", "\\$\\{.*\\}"}};
  schema = {{"anyOf", ordered_json::array({schema, expression})}};
  if (!description.is_null()) schema["description"] = description;
}

ordered_json SystemsSchema(const Catalogue& catalogue) {
  ordered_json any = ordered_json::array();
  for (const Catalogue::Row& row : catalogue.rows()) {
    ordered_json schema = SchemaOfFields(row->fields(), row->new_params().get());
    ordered_json properties{{"type", {{"const", row->type}, {"description", row->doc.summary}}}};
    for (auto& [key, property] : schema["properties"].items()) {
      AllowExpressions(property);
      properties[key] = property;
    }
    schema["properties"] = properties;
    schema["description"] = row->doc.summary;
    ordered_json condition{{"properties", {{"type", {{"const", row->type}}}}}};
    any.push_back({{"if", condition}, {"then", schema}});
  }
  ordered_json types = ordered_json::array();
  for (const Catalogue::Row& row : catalogue.rows()) types.push_back(row->type);
  return MapOf({{"type", "object"},
                {"required", {"type"}},
                {"properties", {{"type", {{"enum", types}}}}},
                {"allOf", any}});
}

}  // namespace

std::string DiagramSchema(const Catalogue& catalogue) {
  ordered_json sections;
  const ordered_json text{{"type", "string"}};
  sections["name"] = text;
  sections["description"] = text;
  sections["include"] = {{"type", "array"}, {"items", text}};
  sections["parameters"] = {{"type", "object"}};
  sections["simulator"] = SchemaOf(ParamTypeOf<SimulatorParams>());
  sections["simulator_tolerances"] = MapOf(SchemaOf(ParamTypeOf<Tolerances>()));
  sections["sampling"] = SamplingSchema();
  sections["packages"] = MapOf(text);
  sections["models"] = MapOf(SchemaOf(ParamTypeOf<ModelParams>()));
  for (const char* key : {"simulator", "simulator_tolerances", "sampling", "models"}) {
    AllowExpressions(sections[key]);
  }
  sections["systems"] = SystemsSchema(catalogue);
  sections["connections"] = {{"type", "array"},
                             {"items", {{"type", "string"}, {"pattern", "^\\S+ *-> *\\S+$"}}}};
  const auto rate = [](const char* meaning) -> ordered_json {
    return {
        {"type", "number"}, {"exclusiveMinimum", 0}, {"description", meaning}, {"x-unit", "Hz"}};
  };
  ordered_json signals = MapOf(rate("of `system.port`, or of all that `system.*` names"));
  signals["description"] = "signals and how often to keep them";
  sections["record"] = {
      {"type", "object"},
      {"additionalProperties", false},
      {"properties",
       {{"signals", signals}, {"scene", rate("of the scene that report and view show")}}}};
  AllowExpressions(sections["record"]);
  sections["expect"] = MapOf(SchemaOf(ParamTypeOf<ExpectParams>()));
  AllowExpressions(sections["expect"]);
  for (const Section& section : Sections()) sections[section.key]["description"] = section.meaning;
  const ordered_json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
                            {"title", "OCA diagram"},
                            {"type", "object"},
                            {"additionalProperties", false},
                            {"properties", sections}};
  return schema.dump(2);
}

}  // namespace oca::diagrams
