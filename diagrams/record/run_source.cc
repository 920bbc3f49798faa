// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/run_source.h"

#include <algorithm>
#include <string>
#include <utility>

#include "oca/diagrams/record/run_metadata.h"
#include "oca/diagrams/runs/run_warnings.h"

namespace oca::record {
namespace {

/// What a warning says, without its place.
std::string WithoutPlace(const std::string& warning) {
  const std::size_t at = warning.find("warning: ");
  return at == std::string::npos ? warning : warning.substr(at);
}

/// While nothing is changed, the warnings that the record was made with (that nothing uses a
/// parameter is seen in the files as they were written, not in the one that was made of them), else
/// the diagram's own. Places are in the record, not in the folder that it was put into.
std::vector<std::string> AllWarnings(const McapFile& record, const std::string& file,
                                     const std::string& folder, bool changed,
                                     const loading::LoadedDiagram& loaded) {
  const bool own = changed || record.FindMetadata("oca.warnings") == nullptr;
  std::vector<std::string> warnings = own ? loaded.warnings : WarningsOf(record);
  for (const std::string& found : runs::RunWarnings(loaded)) {
    const bool told = std::any_of(warnings.begin(), warnings.end(), [&](const auto& other) {
      return WithoutPlace(other) == WithoutPlace(found);
    });
    if (!told) warnings.push_back(found);
  }
  for (std::string& warning : warnings) {
    const std::size_t at = warning.find(folder);
    if (at != std::string::npos) warning.replace(at, folder.size(), file);
  }
  return warnings;
}

}  // namespace

RunSource::RunSource(const std::filesystem::path& file,
                     const std::vector<files::Override>& overrides,
                     const files::Catalogue& catalogue) {
  if (!IsRecord(file)) {
    loaded_ = loading::LoadDiagram(file, overrides, catalogue);
    runs::AddRunWarnings(loaded_);
    return;
  }
  const auto record = McapFile::Read(file);
  extracted_.emplace(record);
  loaded_ = extracted_->Load(overrides, catalogue);
  loaded_.warnings =
      AllWarnings(record, file.string(), extracted_->diagram().parent_path().string(),
                  !overrides.empty(), loaded_);
}

}  // namespace oca::record
