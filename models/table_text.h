// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace oca::models::internal {

/// Whether it keeps cells apart: a blank or a tab.
bool IsBlank(char c);

/// Without the blanks and tabs around it.
std::string_view Trimmed(std::string_view text);

/// With small letters; ASCII alone.
std::string Lower(std::string_view text);

/// The beginning of a cell, printable.
std::string Shown(std::string_view cell);

/// Whether a cell was meant for a number, be it with a decimal comma.
bool LooksLikeNumber(std::string cell);

/// Cuts `text` at tabs and blanks.
std::vector<std::string_view> Words(std::string_view text);

/// The number that all of `word` is, a + may lead it; infinities and NaN count as numbers.
std::optional<double> ToNumber(std::string_view word);

/// The whole number that all of `word` is, if it is at most `most`.
std::optional<std::uint64_t> ToCount(std::string_view word, std::uint64_t most);

/// Takes the first line off `rest`, without its line end.
std::string_view TakeLine(std::string_view& rest);

/// The same of line number `line` of a file, which Words may cut: its words take many times its
/// room. throws ModelError if it is longer than 10 million characters
std::string_view TakeTableLine(const std::filesystem::path& file, int line, std::string_view& rest);

/// throws ModelError "file:line: what; got X; expected Y"; without the line if it is 0
[[noreturn]] void RefuseText(const std::filesystem::path& file, int line, std::string_view what,
                             std::string_view got, std::string_view expected);

}  // namespace oca::models::internal
