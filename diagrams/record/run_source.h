// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/record/extracted_record.h"

namespace oca::record {

/// What a run can be made of: a diagram file, or a record, whose own diagram it is then. Its
/// warnings are all there are: those of the file, of loops that must chatter, and, while nothing of
/// a record is changed, those that it was made with, with their places in the record.
class RunSource {
 public:
  /// throws ConfigError as loading::LoadDiagram and ExtractedRecord do.
  explicit RunSource(const std::filesystem::path& file,
                     const std::vector<files::Override>& overrides = {},
                     const files::Catalogue& catalogue = files::Catalogue::Standard());

  const loading::LoadedDiagram& loaded() const { return loaded_; }

 private:
  std::optional<ExtractedRecord> extracted_;
  loading::LoadedDiagram loaded_;
};

}  // namespace oca::record
