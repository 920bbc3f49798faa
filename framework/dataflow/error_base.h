// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace oca {

/// Base of every exception that OCA throws on purpose: of the framework's (error.h) and of models
/// (models/error.h), which know nothing else of each other.
/// The text reads `where: what; got X; expected Y`. U+0000, which names in JSON, YAML and binary
/// files may hold and which would end `what()`, is spelt `\x00`.
struct Error : std::runtime_error {
  explicit Error(const std::string& text) : std::runtime_error(Whole(text)) {}

 private:
  static std::string Whole(std::string text) {
    for (std::size_t at = 0; (at = text.find('\0', at)) != std::string::npos;) {
      text.replace(at, 1, "\\x00");
    }
    return text;
  }
};

}  // namespace oca
