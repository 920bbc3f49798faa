// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "oca/models/whole_file.h"

namespace oca::runs {

/// One signal of a run as a file, whoever writes it: `run --csv` while it goes on, or `export` from
/// its record.
///
/// Numbers in columns become `SIGNAL.csv`: a line of names as models::CsvTable reads them, `time`
/// first, then the joints or PORT[0], PORT[1], ...; names are quoted where need be (RFC 4180), and
/// a joint called time becomes time_2. Anything else becomes `SIGNAL.jsonl`, one object {"time",
/// "value"} a line, the value as MakeObject has it. All numbers have as many digits as it takes to
/// read back the same bits; times are whole nanoseconds, as in records, in s. It is a WholeFile.
class SignalTable {
 public:
  /// The columns of a vector: its joints, or numbered.
  static std::vector<std::string> Columns(const std::string& port, int size,
                                          const std::vector<std::string>& joints);
  /// Where the file of a signal lies in a folder.
  static std::filesystem::path FileOf(const std::filesystem::path& folder,
                                      const std::string& signal, bool in_columns);

  /// Without columns it takes values as JSON. throws ModelError if the file cannot be made.
  SignalTable(const std::filesystem::path& folder, const std::string& signal,
              const std::optional<std::vector<std::string>>& columns);

  /// No heap once a row of that length was written.
  void Write(std::int64_t nanoseconds, std::span<const double> numbers);
  void Write(std::int64_t nanoseconds, std::string_view json);
  /// Puts the file in its place. throws ModelError naming it if it could not be written to the end.
  void Finish();

 private:
  models::WholeFile file_;
  std::string line_;
};

/// Makes an object of the value of a signal that begins at `start`, unless it is one: a list
/// becomes {"port": [...]}. So values stand in records and in files of a signal.
void MakeObject(std::string& json, std::size_t start, const std::string& port);

/// Time of a run as a record has it. t s
std::int64_t Nanoseconds(double t);

/// throws ConfigError if the folder cannot be made
void MakeFolder(const std::filesystem::path& folder);

}  // namespace oca::runs
