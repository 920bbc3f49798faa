// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/record/mcap_reader.h"

namespace oca::record {

/// Writes the attachments of a record into a folder, from which `diagram.yaml` can be run.
/// throws ConfigError if there is no such attachment, two of one name, or a name that would leave
/// the folder.
void ExtractFiles(const McapFile& record, const std::filesystem::path& folder);

/// The files of a record in a temporary folder of its own, gone with this.
class ExtractedRecord {
 public:
  /// throws ConfigError as ExtractFiles does.
  explicit ExtractedRecord(const McapFile& record);
  ~ExtractedRecord();
  ExtractedRecord(const ExtractedRecord&) = delete;
  ExtractedRecord& operator=(const ExtractedRecord&) = delete;

  std::filesystem::path diagram() const { return folder_ / "diagram.yaml"; }
  /// Reads nothing but what came with the record and packages of this machine, whatever it names.
  /// The diagram as it ran, or with further overrides: then made from its sources, if what they
  /// name lies beside them, so that a parameter may choose other files. What the record does not
  /// have of a package is taken from this machine. throws ConfigError as LoadDiagram does.
  loading::LoadedDiagram Load(
      const std::vector<files::Override>& overrides,
      const files::Catalogue& catalogue = files::Catalogue::Standard()) const;

 private:
  void Remove();
  std::filesystem::path folder_;
};

/// Whether a file begins as an MCAP file does.
bool IsRecord(const std::filesystem::path& file);

}  // namespace oca::record
