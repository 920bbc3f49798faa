// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace oca {

/// Base of every exception that OCA throws on purpose: of the framework's (error.h) and of models
/// (models/error.h), which know nothing else of each other.
/// The text reads `where: what; got X; expected Y`. U+0000, which names in JSON, YAML and binary
/// files may hold and which would end `what()`, is spelt `\x00`.
struct Error : std::runtime_error {
  explicit Error(const std::string& text) : std::runtime_error(Whole(text)) {}

  /// Puts `where: ` before each line of the text, for whoever knows more of the place and throws
  /// on.
  void AddWhere(const std::string& where) {
    std::string text;
    for (std::string_view rest = what(); !rest.empty();) {
      const std::string_view line = rest.substr(0, rest.find('\n'));
      text += (text.empty() ? "" : "\n") + where + ": ";
      text += line;
      rest.remove_prefix(line.size() == rest.size() ? line.size() : line.size() + 1);
    }
    static_cast<std::runtime_error&>(*this) = std::runtime_error(text);
  }

 private:
  static std::string Whole(std::string text) {
    for (std::size_t at = 0; (at = text.find('\0', at)) != std::string::npos;) {
      text.replace(at, 1, "\\x00");
    }
    return text;
  }
};

}  // namespace oca
