// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace oca::robot::xacro {

/// A piece of a text with expressions in it.
struct TextPart {
  enum class Kind {
    kEnd,
    kText,
    kExpression,    ///< `text` of ${text}
    kSubstitution,  ///< `text` of $(text)
  };
  Kind kind{Kind::kEnd};
  std::string text{};
};

/// Cuts a text into its pieces. A $ more before ${ or $( makes it plain text: $${ is ${.
class TextParts {
 public:
  explicit TextParts(std::string_view text) : text_(text) {}

  /// throws Mistake for an expression without end
  TextPart Next();
  bool AtEnd() const { return at_ >= text_.size(); }

 private:
  std::size_t EndOfExpression() const;
  std::size_t EndOfSubstitution() const;

  std::string_view text_;
  std::size_t at_{0};
};

}  // namespace oca::robot::xacro
