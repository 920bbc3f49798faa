// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/tokens.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include "oca/models/foreign_text.h"
#include "oca/models/robot/xacro/expression.h"

namespace oca::robot::xacro {
namespace {

bool StartsName(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool IsNumeral(char c) { return c >= '0' && c <= '9'; }

class TokenReader {
 public:
  explicit TokenReader(std::string_view text) : text_(text) {}

  std::vector<Token> Read() {
    std::vector<Token> tokens;
    while (SkipBlanks(), at_ < text_.size()) {
      const char c = text_[at_];
      if (StartsName(c)) {
        tokens.push_back(Name());
      } else if (IsNumeral(c) || (c == '.' && IsNumeral(Peek(1)))) {
        tokens.push_back(Number());
      } else if (c == '\'' || c == '"') {
        tokens.push_back(Text());
      } else {
        tokens.push_back(Operator());
      }
    }
    tokens.emplace_back();
    return tokens;
  }

 private:
  char Peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }

  void SkipBlanks() {
    while (at_ < text_.size() &&
           std::string_view(" \t\r\n").find(text_[at_]) != std::string::npos) {
      ++at_;
    }
  }

  Token Name() {
    const std::size_t from = at_;
    while (StartsName(Peek()) || IsNumeral(Peek())) ++at_;
    std::string name(text_.substr(from, at_ - from));
    if (Peek() == '\'' || Peek() == '"') {
      throw Mistake("text with a prefix", fmt::format("{}{}", name, Peek()), "a text in quotes");
    }
    return {Token::Kind::kName, std::move(name), {}};
  }

  void TakeDigits(std::string& digits) {
    while (IsNumeral(Peek()) || (Peek() == '_' && !digits.empty() && IsNumeral(Peek(1)))) {
      if (Peek() != '_') digits += Peek();
      ++at_;
    }
  }

  Token Number() {
    const std::size_t from = at_;
    std::string digits;
    bool whole = true;
    TakeDigits(digits);
    if (Peek() == '.') {
      whole = false;
      digits += '.';
      ++at_;
      TakeDigits(digits);
    }
    if (Peek() == 'e' || Peek() == 'E') {
      const std::size_t sign = Peek(1) == '+' || Peek(1) == '-' ? 1 : 0;
      if (IsNumeral(Peek(1 + sign))) {
        whole = false;
        digits += 'e';
        if (sign > 0 && Peek(1) == '-') digits += '-';
        at_ += 1 + sign;
        TakeDigits(digits);
      }
    }
    const std::string written(text_.substr(from, at_ - from));
    if (StartsName(Peek())) Fail("number", fmt::format("{}{}", written, Peek()), "a number");
    return {Token::Kind::kConstant, written, ValueOf(digits, whole, written)};
  }

  static PythonValue ValueOf(const std::string& digits, bool whole, const std::string& written) {
    const char* const end = digits.data() + digits.size();
    if (whole) {
      std::int64_t number = 0;
      if (std::from_chars(digits.data(), end, number).ec != std::errc()) {
        Fail("whole number", written, "one of 64 bits");
      }
      if (digits.size() > 1 && digits[0] == '0' && number != 0) {
        Fail("whole number", written, "one without leading zeros");
      }
      return PythonValue(number);
    }
    double number = 0.0;
    if (std::from_chars(digits.data(), end, number).ec != std::errc()) {
      Fail("number", written, "one that a double can hold");
    }
    return PythonValue(number);
  }

  Token Text() {
    const char quote = text_[at_++];
    const std::size_t from = at_;
    std::string text;
    while (at_ < text_.size() && text_[at_] != quote) {
      if (text_[at_] == '\\') {
        TakeEscape(text);
      } else {
        text += text_[at_++];
      }
    }
    if (at_ >= text_.size()) {
      Fail("text", fmt::format("{}{} without end", quote, text_.substr(from, 40)),
           "a closing quote");
    }
    ++at_;
    return {Token::Kind::kConstant, std::string(text_.substr(from, at_ - 1 - from)),
            PythonValue(std::move(text))};
  }

  /// What a backslash and what follows stand for. source Python, Lexical analysis, 2.4.1
  void TakeEscape(std::string& text) {
    constexpr std::string_view kWritten = "abfnrtv\\'\"", kMeant = "\a\b\f\n\r\t\v\\'\"";
    ++at_;
    const char kind = Peek();
    if (const std::size_t known = kWritten.find(kind); known != kWritten.npos) {
      text += kMeant[known];
      ++at_;
    } else if (kind == 'x' || kind == 'u' || kind == 'U') {
      ++at_;
      TakeCode(kind == 'x' ? 2 : kind == 'u' ? 4 : 8, kind, text);
    } else if (kind >= '0' && kind <= '7') {
      std::uint32_t code = 0;
      for (int i = 0; i < 3 && Peek() >= '0' && Peek() <= '7'; ++i) {
        code = 8 * code + static_cast<std::uint32_t>(text_[at_++] - '0');
      }
      models::internal::AppendUtf8(text, code);
    } else if (kind == 'N') {
      Fail("text", "\\N, a character by its name", "\\u and its number, or the character itself");
    } else if (kind == '\n') {
      ++at_;
    } else {
      text += '\\';  // as Python, which only warns
    }
  }

  void TakeCode(std::size_t digits, char kind, std::string& text) {
    const std::string_view written = text_.substr(at_, digits);
    std::uint32_t code = 0;
    const char* const end = written.data() + written.size();
    const auto [stop, error] = std::from_chars(written.data(), end, code, 16);
    if (written.size() < digits || error != std::errc() || stop != end) {
      Fail("text", fmt::format("\\{}{}", kind, written),
           fmt::format("{} hexadecimal digits behind \\{}", digits, kind));
    }
    if (code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) {
      Fail("text", fmt::format("\\{}{}", kind, written), "a character of Unicode");
    }
    models::internal::AppendUtf8(text, code);
    at_ += digits;
  }

  Token Operator() {
    static constexpr std::array<std::string_view, 23> kOperators = {
        "**", "//", "<=", ">=", "==", "!=", "+", "-", "*", "/", "%", "<",
        ">",  "(",  ")",  "[",  "]",  "{",  "}", ",", ":", ".", "="};
    for (const std::string_view known : kOperators) {
      if (!text_.substr(at_).starts_with(known)) continue;
      at_ += known.size();
      return {Token::Kind::kOperator, std::string(known), {}};
    }
    Fail("character", fmt::format("'{}'", text_.substr(at_, 1)), kExpressionParts);
  }

  [[noreturn]] static void Fail(std::string_view what, std::string_view got,
                                std::string_view expected) {
    throw Mistake(what, got, expected);
  }

  std::string_view text_;
  std::size_t at_{0};
};

}  // namespace

std::vector<Token> ReadTokens(std::string_view text) { return TokenReader(text).Read(); }

}  // namespace oca::robot::xacro
