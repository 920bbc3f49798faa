// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/text_parts.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

TextPart TextParts::Next() {
  using enum TextPart::Kind;
  if (AtEnd()) return {};
  const std::size_t from = at_;
  if (text_[at_] != '$') {
    at_ = std::min(text_.find('$', at_), text_.size());
    return {kText, std::string(text_.substr(from, at_ - from))};
  }
  const std::size_t after = std::min(text_.find_first_not_of('$', at_), text_.size());
  const char bracket = after < text_.size() ? text_[after] : '\0';
  const std::size_t dollars = after - at_;
  if (bracket != '{' && bracket != '(') {
    at_ = std::min(text_.find('$', after), text_.size());
    return {kText, std::string(text_.substr(from, at_ - from))};
  }
  if (dollars > 1) {
    at_ = after + 1;
    return {kText, std::string(text_.substr(from + 1, at_ - from - 1))};
  }
  at_ = after + 1;
  const std::size_t end = bracket == '{' ? EndOfExpression() : EndOfSubstitution();
  if (end >= text_.size()) {
    throw Mistake("expression", fmt::format("'{}' without end", text_.substr(from, 60)),
                  bracket == '{' ? "a closing }" : "a closing )");
  }
  TextPart part{bracket == '{' ? kExpression : kSubstitution,
                std::string(text_.substr(at_, end - at_))};
  at_ = end + 1;
  return part;
}

/// The brace that closes it, others being in pairs or in texts; else the first one.
std::size_t TextParts::EndOfExpression() const {
  int depth = 0;
  char quote = '\0';
  for (std::size_t i = at_; i < text_.size(); ++i) {
    const char c = text_[i];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '\'' || c == '"') {
      quote = c;
    } else if (c == '{') {
      ++depth;
    } else if (c == '}' && depth-- == 0) {
      return i;
    }
  }
  return text_.find('}', at_);
}

/// The parenthesis that closes it; those in expressions within it do not.
std::size_t TextParts::EndOfSubstitution() const {
  int depth = 0;
  for (std::size_t i = at_; i < text_.size(); ++i) {
    if (text_.substr(i).starts_with("${")) ++depth;
    if (text_[i] == '}' && depth > 0) --depth;
    if (text_[i] == ')' && depth == 0) return i;
  }
  return text_.find(')', at_);
}

}  // namespace oca::robot::xacro
