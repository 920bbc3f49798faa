// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace oca::models {

/// A table in a text file, row after row: the one reader of all tables.
///
///     CsvTable table(file);
///     const auto columns = table.Columns({"x", "y", "z"});
///     while (table.NextRow()) points.push_back(table.Number(columns[0])), ...
///
/// Text is UTF-8, with or without a byte-order mark. Cells are apart by what the first row has:
/// semicolons, tabs, commas or blanks; cells come without the blanks around them and without
/// quotes, in which they may hold separators, line ends and "" for " (RFC 4180). Blank lines and
/// lines that start with # are skipped. All rows are as long as the first one.
///
/// A first row in which no cell is a number names the columns; a number in quotes counts as a name
/// beside others. Without it a comment just before the first row may name them, as NumPy writes it.
///
/// Refusals are ModelErrors `file:line: ...` that show of the file printable ASCII only, so that a
/// terminal is safe from its bytes.
class CsvTable {
 public:
  /// Reads the file whole.
  /// throws ModelError for a file that cannot be read or is too large, for UTF-16 and UTF-32, for
  /// control characters, comments included, and for a first row that cannot be told apart
  explicit CsvTable(const std::filesystem::path& file);
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  /// Of the columns, from left to right; empty if nothing names them.
  const std::vector<std::string>& names() const { return names_; }
  /// Where the columns of these names are, upper and lower case alike; empty if nothing names any.
  /// throws ModelError for one that is missing or there twice
  std::vector<std::size_t> Columns(const std::vector<std::string>& wanted);
  /// Whether there is a column of that name.
  bool Has(std::string_view name) const;

  /// Goes on to the next row of values; false behind the last.
  /// throws ModelError for a row of another length or a million values, for quotes that do not fit
  bool NextRow();

  /// How many columns there are; 0 without any row.
  std::size_t width() const { return width_; }
  /// Of the present row.
  const std::vector<std::string>& cells() const { return cells_; }
  /// `file:line` of the present row, before the first one that of the names.
  std::string where() const;
  /// A cell of the present row; a + may lead it.
  /// throws ModelError unless it is a finite number
  double Number(std::size_t column) const;
  /// The same; NaN and infinities count as numbers.
  double AnyNumber(std::size_t column) const;

 private:
  [[noreturn]] void RefuseCell(std::size_t column, std::string_view expected) const;
  [[noreturn]] void RefuseRow(std::string_view what, std::string_view got,
                              std::string_view expected) const;
  void CheckBytes();
  void ReadFirst();
  void ChooseSeparator();
  bool ReadRow();
  void ReadCell();
  void ReadQuoted(std::string& cell);
  void SkipBlanks();
  bool AtEnd() const;
  void TakeLineEnd();

  const std::filesystem::path file_;
  std::string text_;
  std::size_t at_{0};     // what is read next
  int line_{1};           // of the present row
  int next_line_{1};      // at `at_`
  char separator_{'\0'};  // ' ' means blanks and tabs; none before the first row
  std::vector<std::string> names_;
  std::vector<std::string> commented_;  // names that a comment may give
  std::string comment_;                 // the last one before the first row
  std::vector<std::string> cells_;
  std::vector<bool> quoted_;
  std::size_t width_{0};
  bool pending_{false};  // the present row was read ahead
};

}  // namespace oca::models
