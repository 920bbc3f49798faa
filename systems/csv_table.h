// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace oca::systems {

/// The rows of a file of comma separated values, one after another. Cells come without the blanks
/// around them; blank lines and lines that start with # are skipped.
///
///     CsvTable table(file);
///     while (table.NextRow()) times.push_back(table.Number(0));
///
/// Refusals show of the file printable ASCII only, so that a terminal is safe from its bytes.
class CsvTable {
 public:
  static constexpr std::uintmax_t kLargestFile = 64u << 20;  ///< bytes; days of key points

  /// Reads the file whole.
  /// throws ConfigError for what is no regular file, before opening it, and for one that is larger
  /// than kLargestFile, before reading it.
  explicit CsvTable(const std::string& file);
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  /// Goes on to the next row; false behind the last.
  /// throws ConfigError at a control character, comments included.
  bool NextRow();

  /// Of the present row, valid as long as the table; at least one.
  const std::vector<std::string_view>& cells() const { return cells_; }
  /// `file:line` of the present row.
  std::string where() const;
  /// A cell of the present row; a + may lead it.
  /// throws ConfigError unless it is a finite number.
  double Number(std::size_t column) const;

 private:
  const std::string file_;
  std::string text_;
  std::size_t next_{0};  // where in the text the next line begins
  int line_{0};          // counted from 1
  std::vector<std::string_view> cells_;
};

}  // namespace oca::systems
