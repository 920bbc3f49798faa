// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/run_metadata.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "oca/diagrams/record/yaml_writer.h"
#include "oca/diagrams/runs/blind_spots.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"

namespace oca::record {

Texts ParameterTexts(const loading::LoadedDiagram& loaded) {
  Texts texts;
  const Value* const parameters = loaded.document.Find("parameters");
  if (parameters == nullptr || parameters->map() == nullptr) return texts;
  for (const Value::Entry& entry : *parameters->map()) {
    texts[entry.key] = WriteYamlValue(entry.value);
  }
  return texts;
}

Texts OverrideTexts(const std::vector<files::Override>& overrides) {
  Texts texts;
  for (const files::Override& change : overrides) texts[change.path] = change.value;
  return texts;
}

Texts WarningTexts(const std::vector<std::string>& warnings) {
  return {{"warnings", oca::internal::JsonText(nlohmann::json(warnings))}};
}

std::vector<std::string> WarningsOf(const McapFile& record) {
  std::vector<std::string> warnings;
  const Texts* const texts = record.FindMetadata("oca.warnings");
  if (texts == nullptr || !texts->contains("warnings")) return warnings;
  try {
    for (const auto& warning : oca::internal::ReadJsonTree(texts->at("warnings"))) {
      if (warning.is_string()) warnings.push_back(warning.get<std::string>());
    }
  } catch (const ConfigError& error) {
    throw ConfigError(
        fmt::format("{}: metadata oca.warnings: warnings: {}", record.name(), error.what()));
  }
  return warnings;
}

std::string NotSeenJson(const loading::LoadedDiagram& loaded) {
  return oca::internal::JsonText(nlohmann::json(runs::BlindSpots(loaded)));
}

}  // namespace oca::record
