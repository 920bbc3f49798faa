// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>
#include <span>
#include <string_view>

namespace oca::test {

/// A reader of bytes that anyone may have written. It may refuse them by an exception of ours,
/// which says why; anything else that leaves it, and whatever a sanitizer finds, is a fault.
struct Reader {
  enum class Kind { kBinary, kText };
  const char* name;
  Kind kind;  ///< of text fewer inputs tell something new, and take longer
  bool (*read)(std::string_view bytes);  ///< whether it accepted them
};

/// For messages of tests.
inline void PrintTo(const Reader& reader, std::ostream* to) { *to << reader.name; }

/// All of them.
std::span<const Reader> Readers();

}  // namespace oca::test
