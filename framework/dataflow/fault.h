// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>

namespace oca {

/// How closely a value is looked at.
enum class Look {
  kFinite,  ///< what a system computed, each time: all that spoils or crashes what reads it
  kWhole    ///< what comes from outside, once more: all that systems rely on
};

/// What is wrong with a value, `where; got X; expected Y`, if anything is. Of fixed size: telling
/// takes no memory, and telling that all is well next to no time. Longer texts end in "...".
class [[nodiscard]] Fault {
 public:
  /// Nothing is wrong.
  Fault() noexcept { text_[0] = '\0'; }
  explicit Fault(std::string_view text) noexcept;
  static Fault UnlessFinite(bool finite) noexcept {
    return finite ? Fault() : Fault("got a NaN or an infinity; expected finite numbers");
  }

  bool ok() const noexcept { return text_[0] == '\0'; }
  const char* text() const noexcept { return text_.data(); }

 private:
  std::array<char, 192> text_;
};

}  // namespace oca
