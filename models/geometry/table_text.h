// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace oca::models::internal {

/// The content of a file. throws ModelError if it is missing, no plain file, or above 100 MB
std::string ReadWhole(const std::filesystem::path& file);

/// Cuts `text` at commas, semicolons, tabs and blanks.
std::vector<std::string_view> Words(std::string_view text);

/// The number that all of `word` is; infinities and NaN count as numbers.
std::optional<double> ToNumber(std::string_view word);

/// Takes the first line off `rest`, without its line end.
std::string_view TakeLine(std::string_view& rest);

/// throws ModelError "file:line: what; got X; expected Y"; without the line if it is 0
[[noreturn]] void RefuseText(const std::filesystem::path& file, int line, std::string_view what,
                             std::string_view got, std::string_view expected);

}  // namespace oca::models::internal
