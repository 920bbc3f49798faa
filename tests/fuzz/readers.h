// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

namespace oca::test {

/// A reader of bytes that anyone may have written. It may refuse them by the errors that it
/// documents; anything else that leaves it, and whatever a sanitizer finds, is a fault.
struct Reader {
  const char* name;
  bool (*read)(std::string_view bytes);  ///< whether it accepted them
};

/// All of them, by name.
std::span<const Reader> Readers();

}  // namespace oca::test
