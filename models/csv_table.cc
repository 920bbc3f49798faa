// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/csv_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <tuple>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/nearest_name.h"
#include "oca/models/table_text.h"

namespace oca::models {
namespace {

using internal::IsBlank;
using internal::LooksLikeNumber;
using internal::Lower;
using internal::Shown;
using internal::ToNumber;
using internal::Trimmed;

constexpr std::size_t kMostColumns = 1'000'000;  // each takes dozens of bytes while it is read

bool IsControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte < 0x20 && c != '\t' && c != '\r' && c != '\n') || byte == 0x7f;
}

/// A line without what stands in quotes, a letter for each.
std::string WithoutQuoted(std::string_view line) {
  std::string bare;
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    bare += quoted || c == '"' ? 'q' : c;
  }
  return bare;
}

/// Whether a line has a tab that is more than padding beside a comma, or between numbers that
/// blanks keep apart, too.
bool TabsSeparate(std::string_view line) {
  bool separates = false;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t tab = std::min(line.find('\t', from), line.size());
    const std::string_view cell = Trimmed(line.substr(from, tab - from));
    const auto words = internal::Words(cell);
    const bool numbers = std::all_of(words.begin(), words.end(),
                                     [](std::string_view word) { return ToNumber(word); });
    if (words.size() > 1 && numbers) return false;
    if (tab < line.size()) {
      const std::string_view before = Trimmed(line.substr(0, tab));
      const std::string_view behind = Trimmed(line.substr(tab));
      separates = separates || !(before.ends_with(',') || behind.starts_with(','));
    }
    from = tab + 1;
  }
  return separates;
}

/// Where a name is among others: as it is written, or else whatever its capitals.
std::vector<std::size_t> Places(const std::vector<std::string>& names, const std::string& name) {
  std::vector<std::size_t> exact, alike;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) exact.push_back(i);
    if (Lower(names[i]) == Lower(name)) alike.push_back(i);
  }
  return exact.empty() ? alike : exact;
}

/// What a comment may name columns by, however they are separated, each without its unit.
std::vector<std::string> Words(const std::string& comment) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < comment.size();) {
    const std::size_t end = std::min(comment.find_first_of(",; \t", at), comment.size());
    std::string word = comment.substr(at, end - at);
    word.erase(std::min(word.find_first_of("[("), word.size()));
    if (!word.empty() && !word.ends_with(':')) words.push_back(std::move(word));
    at = end + 1;
  }
  return words;
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& file) : file_(file), text_(ReadFile(file)) {
  CheckBytes();
  ReadFirst();
}

std::string CsvTable::where() const { return fmt::format("{}:{}", file_.string(), line_); }

void CsvTable::RefuseRow(std::string_view what, std::string_view got,
                         std::string_view expected) const {
  throw ModelError(fmt::format("{}: {}; got {}; expected {}", where(), what, got, expected));
}

void CsvTable::RefuseCell(std::size_t column, std::string_view expected) const {
  const std::string& cell = cells_.at(column);
  const std::string name =
      column < names_.size() ? fmt::format(" ('{}')", Shown(names_[column])) : "";
  const bool comma = cell.find(',') != std::string::npos;
  throw ModelError(fmt::format("{}: column {}{}: not a number; got '{}'; expected {}{}", where(),
                               column + 1, name, Shown(cell), expected,
                               comma ? ", with a decimal point" : ""));
}

/// Refuses what is no UTF-8 text and skips the mark of what is.
void CsvTable::CheckBytes() {
  using std::literals::operator""sv;
  for (const auto& [mark, name] :
       {std::pair("\xFF\xFE\0\0"sv, "UTF-32"), std::pair("\0\0\xFE\xFF"sv, "UTF-32"),
        std::pair("\xFF\xFE"sv, "UTF-16"), std::pair("\xFE\xFF"sv, "UTF-16")}) {
    if (text_.starts_with(mark)) RefuseRow("encoding", name, "UTF-8; save it as such");
  }
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  const auto control = std::find_if(text_.begin(), text_.end(), IsControl);
  if (control == text_.end()) return;
  line_ = 1 + static_cast<int>(std::count(text_.begin(), control, '\n'));
  RefuseRow("control character", fmt::format("byte {:#04x}", static_cast<unsigned char>(*control)),
            "text");
}

/// The row of names, or what a comment says in its place before a row of values.
void CsvTable::ReadFirst() {
  if (!ReadRow()) return;
  const bool comment = cells_.front().starts_with("//") && !quoted_.front();
  if (comment) cells_.front().erase(0, 2);
  if (comment && cells_.front().empty() && cells_.size() > 1) {
    cells_.erase(cells_.begin());
    quoted_.erase(quoted_.begin());
  }
  width_ = cells_.size();
  bool numbers = true, bare_number = false;
  for (std::size_t i = 0; i < width_; ++i) {
    const bool number = LooksLikeNumber(cells_[i]);
    numbers = numbers && number;
    bare_number = bare_number || (number && !quoted_[i]);
  }
  if (!numbers && !bare_number) {
    names_ = std::move(cells_);
    cells_.clear();
    return;
  }
  if (comment) return ReadFirst();  // a row that was put aside
  pending_ = true;
  const auto row = std::tuple(cells_, quoted_, at_, line_, next_line_);
  std::string text = std::exchange(text_, comment_);
  at_ = 0;
  try {
    if (ReadRow() && cells_.size() == width_) commented_ = cells_;
  } catch (const ModelError&) {  // separated otherwise, or no names
  }
  if (commented_.empty()) commented_ = Words(comment_);
  text_ = std::move(text);
  std::tie(cells_, quoted_, at_, line_, next_line_) = row;
}

std::vector<std::size_t> CsvTable::Columns(const std::vector<std::string>& wanted) {
  if (names_.empty() && std::all_of(wanted.begin(), wanted.end(), [&](const std::string& name) {
        return Places(commented_, name).size() == 1;
      })) {
    if (commented_.size() == width_) {
      names_ = commented_;
    } else if (wanted.size() > 1) {
      RefuseRow("comment that names columns", fmt::format("{} words", commented_.size()),
                fmt::format("a name for each of {} columns, or none of {}", width_,
                            fmt::join(wanted, ", ")));
    }
  }
  std::vector<std::size_t> columns;
  if (names_.empty()) return columns;
  for (const std::string& name : wanted) {
    const std::vector<std::size_t> places = Places(names_, name);
    if (places.size() != 1) {
      const bool none = places.empty();
      std::vector<std::string> shown;
      for (const std::string& other : names_) shown.push_back(Shown(other));
      RefuseRow(
          fmt::format("names of columns: {} '{}'", none ? "no" : "more than one", Shown(name)),
          fmt::format("{}", fmt::join(shown, ", ")),
          !none ? "each name once"
                : fmt::format("{}; nearest is '{}'", fmt::join(wanted, ", "),
                              NearestName(name, shown)));
    }
    columns.push_back(places.front());
  }
  return columns;
}

bool CsvTable::Has(std::string_view name) const {
  return !Places(names_, std::string(name)).empty();
}

bool CsvTable::NextRow() {
  if (pending_) {
    pending_ = false;
    return true;
  }
  if (!ReadRow()) return false;
  if (cells_.size() != width_) {
    RefuseRow("wrong length", fmt::format("{} values", cells_.size()), fmt::format("{}", width_));
  }
  return true;
}

double CsvTable::AnyNumber(std::size_t column) const {
  const auto number = ToNumber(cells_.at(column));
  if (!number) RefuseCell(column, "a number");
  return *number;
}

double CsvTable::Number(std::size_t column) const {
  const auto number = ToNumber(cells_.at(column));
  if (!number || !std::isfinite(*number)) RefuseCell(column, "a finite number");
  return *number;
}

bool CsvTable::AtEnd() const {
  return at_ >= text_.size() || text_[at_] == '\n' || text_[at_] == '\r';
}

void CsvTable::TakeLineEnd() {
  if (at_ >= text_.size() || (text_[at_] != '\r' && text_[at_] != '\n')) return;
  ++at_;
  if (text_[at_ - 1] == '\r' && at_ < text_.size() && text_[at_] == '\n') ++at_;
  ++next_line_;
}

void CsvTable::SkipBlanks() {
  while (at_ < text_.size() && IsBlank(text_[at_]) && text_[at_] != separator_) ++at_;
}

void CsvTable::ChooseSeparator() {
  const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
  const std::string bare = WithoutQuoted(std::string_view(text_).substr(at_, end - at_));
  const std::string_view line = Trimmed(bare);
  separator_ = line.find(';') != std::string_view::npos   ? ';'
               : TabsSeparate(line)                       ? '\t'
               : line.find(',') != std::string_view::npos ? ','
                                                          : ' ';
}

bool CsvTable::ReadRow() {
  while (at_ < text_.size()) {
    line_ = next_line_;
    const std::size_t start = at_;
    while (at_ < text_.size() && IsBlank(text_[at_])) ++at_;
    if (AtEnd()) {
      TakeLineEnd();
      continue;
    }
    if (text_[at_] == '#') {
      const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
      if (separator_ == '\0') {
        const std::size_t words = std::min(text_.find_first_not_of("# \t", at_), end);
        comment_ = text_.substr(words, end - words);
      }
      at_ = end;
      TakeLineEnd();
      continue;
    }
    if (separator_ == '\0') ChooseSeparator();
    if (separator_ == '\t') at_ = start;
    cells_.clear();
    quoted_.clear();
    do {
      ReadCell();
      if (cells_.size() > kMostColumns) {
        RefuseRow("row", fmt::format("more than {} values", kMostColumns), "no more");
      }
    } while (!AtEnd());
    TakeLineEnd();
    return true;
  }
  return false;
}

/// Reads a cell and the separator behind it, of which one at the end of a line begins an empty
/// cell.
void CsvTable::ReadCell() {
  if (separator_ == ' ') {
    while (at_ < text_.size() && IsBlank(text_[at_])) ++at_;
  } else {
    SkipBlanks();
  }
  std::string& cell = cells_.emplace_back();
  const bool quoted = at_ < text_.size() && text_[at_] == '"';
  quoted_.push_back(quoted);
  const std::string_view ends = separator_ == ' '    ? " \t\r\n"
                                : separator_ == '\t' ? "\t\r\n"
                                : separator_ == ';'  ? ";\r\n"
                                                     : ",\r\n";
  if (quoted) ReadQuoted(cell);
  const std::size_t end = std::min(text_.find_first_of(ends, at_), text_.size());
  const std::string_view rest = Trimmed(std::string_view(text_).substr(at_, end - at_));
  if (quoted && !rest.empty()) {
    RefuseRow("text behind a closing quote", fmt::format("'{}'", Shown(rest)),
              "a separator; quotes inside quotes are doubled");
  }
  if (!quoted && rest.find('"') != std::string_view::npos) {
    RefuseRow("quote inside a cell", fmt::format("'{}'", Shown(rest)),
              "quotes around the whole cell, those inside doubled");
  }
  if (!quoted) cell = rest;
  at_ = end;
  if (separator_ == ' ') {
    while (at_ < text_.size() && IsBlank(text_[at_])) ++at_;
    return;
  }
  if (AtEnd()) return;
  ++at_;
  SkipBlanks();
  if (!AtEnd()) return;
  cells_.emplace_back();
  quoted_.push_back(false);
}

void CsvTable::ReadQuoted(std::string& cell) {
  for (++at_; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '"') {
      ++at_;
      if (at_ >= text_.size() || text_[at_] != '"') return;
    }
    if (c == '\n' || (c == '\r' && !(at_ + 1 < text_.size() && text_[at_ + 1] == '\n'))) {
      ++next_line_;
    }
    cell += c;
  }
  RefuseRow("quote", "none that closes", "a quote behind the cell");
}

}  // namespace oca::models
