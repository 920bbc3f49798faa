// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace oca {

/// Base of every exception that OCA throws on purpose: of the framework's (error.h) and of models
/// (models/error.h), which know nothing else of each other.
/// The text reads `where: what; got X; expected Y`.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;

  /// Puts `where: ` before each line of the text, for whoever knows more of the place and throws on.
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
};

}  // namespace oca
