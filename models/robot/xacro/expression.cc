// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "oca/models/robot/xacro/tokens.h"

namespace oca::robot::xacro {
namespace {

using Kind = Expression::Kind;

constexpr std::size_t kLongestExpression = 20'000;
constexpr int kDeepestExpression = 100;

/// Precedence as in Python's reference, lowest first; each function reads one of its levels.
class ExpressionParser {
 public:
  explicit ExpressionParser(std::string_view text) : tokens_(ReadTokens(text)) {}

  ExpressionPtr Parse() {
    if (Here().kind == Token::Kind::kEnd) Fail("nothing");
    ExpressionPtr all = Conditional();
    if (IsOperator(",")) all = TupleAfter(std::move(all));
    if (Here().kind != Token::Kind::kEnd) Fail();
    return all;
  }

 private:
  const Token& Here() const { return tokens_[at_]; }
  bool IsOperator(std::string_view text) const {
    return Here().kind == Token::Kind::kOperator && Here().text == text;
  }
  bool IsWord(std::string_view text) const {
    return Here().kind == Token::Kind::kName && Here().text == text;
  }
  bool Take(std::string_view text) {
    if (!IsOperator(text) && !IsWord(text)) return false;
    ++at_;
    return true;
  }
  void Expect(std::string_view text) {
    if (!Take(text)) {
      throw Mistake("expression", Here().kind == Token::Kind::kEnd ? "its end" : Here().text,
                    fmt::format("'{}'", text));
    }
  }
  [[noreturn]] void Fail(std::string got = "") const {
    if (got.empty()) got = Here().kind == Token::Kind::kEnd ? "its end" : Here().text;
    throw Mistake("expression", got, kExpressionParts);
  }

  template <class... Parts>
  static ExpressionPtr Make(Kind kind, std::string text, Parts... parts) {
    auto made = std::make_unique<Expression>();
    made->kind = kind;
    made->text = std::move(text);
    (Add(*made, std::move(parts)), ...);
    return made;
  }
  static void Add(Expression& to, ExpressionPtr part) {
    if (part != nullptr) to.depth = std::max(to.depth, part->depth + 1);
    if (to.depth > kDeepestExpression) {
      throw Mistake("expression", fmt::format("more than {} levels", kDeepestExpression), "fewer");
    }
    to.parts.push_back(std::move(part));
  }

  ExpressionPtr Conditional() {
    if (++open_ > kDeepestExpression) {
      throw Mistake("expression", fmt::format("more than {} levels", kDeepestExpression), "fewer");
    }
    ExpressionPtr chosen = Or();
    if (Take("if")) {
      ExpressionPtr condition = Or();
      Expect("else");
      chosen = Make(Kind::kConditional, "", std::move(chosen), std::move(condition), Conditional());
    }
    --open_;
    return chosen;
  }

  ExpressionPtr Or() { return Chain("or", Kind::kOr, &ExpressionParser::And); }
  ExpressionPtr And() { return Chain("and", Kind::kAnd, &ExpressionParser::Not); }

  ExpressionPtr Chain(const char* word, Kind kind, ExpressionPtr (ExpressionParser::*next)()) {
    ExpressionPtr first = (this->*next)();
    if (!IsWord(word)) return first;
    ExpressionPtr chain = Make(kind, "", std::move(first));
    while (Take(word)) Add(*chain, (this->*next)());
    return chain;
  }

  ExpressionPtr Not() {
    int count = 0;
    while (Take("not")) ++count;
    ExpressionPtr inner = Comparison();
    if (count == 0) return inner;
    ExpressionPtr made = Make(Kind::kNot, "", std::move(inner));
    return count % 2 == 1 ? std::move(made) : Make(Kind::kNot, "", std::move(made));
  }

  std::string ComparisonWord() {
    for (const char* word : {"==", "!=", "<=", ">=", "<", ">", "in"}) {
      if (Take(word)) return word;
    }
    if (Take("is")) return Take("not") ? "is not" : "is";
    if (IsWord("not") && tokens_[at_ + 1].text == "in") {
      at_ += 2;
      return "not in";
    }
    return "";
  }

  ExpressionPtr Comparison() {
    ExpressionPtr first = Sum();
    std::string word = ComparisonWord();
    if (word.empty()) return first;
    ExpressionPtr made = Make(Kind::kComparison, "", std::move(first));
    for (; !word.empty(); word = ComparisonWord()) {
      made->words.push_back(word);
      Add(*made, Sum());
    }
    return made;
  }

  ExpressionPtr Sum() { return Arithmetic({"+", "-"}, &ExpressionParser::Term); }
  ExpressionPtr Term() { return Arithmetic({"*", "//", "/", "%"}, &ExpressionParser::Factor); }

  ExpressionPtr Arithmetic(std::initializer_list<const char*> words,
                           ExpressionPtr (ExpressionParser::*next)()) {
    ExpressionPtr left = (this->*next)();
    const auto found = [&]() -> std::string {
      for (const char* const word : words) {
        if (Take(word)) return word;
      }
      return "";
    };
    for (std::string word = found(); !word.empty(); word = found()) {
      left = Make(Kind::kArithmetic, word, std::move(left), (this->*next)());
    }
    return left;
  }

  ExpressionPtr Factor() {
    if (++open_ > kDeepestExpression) Fail("too many signs");
    ExpressionPtr made;
    if (Take("-")) {
      made = Make(Kind::kNegative, "", Factor());
    } else if (Take("+")) {
      made = Make(Kind::kPositive, "", Factor());
    } else {
      made = Primary();
      if (Take("**")) made = Make(Kind::kArithmetic, "**", std::move(made), Factor());
    }
    --open_;
    return made;
  }

  ExpressionPtr Primary() {
    ExpressionPtr made = Atom();
    for (;;) {
      if (Take(".")) {
        if (Here().kind != Token::Kind::kName) Fail();
        made = Make(Kind::kAttribute, tokens_[at_++].text, std::move(made));
      } else if (Take("[")) {
        made = Subscript(std::move(made));
      } else if (Take("(")) {
        made = Call(std::move(made));
      } else {
        return made;
      }
    }
  }

  ExpressionPtr Subscript(ExpressionPtr of) {
    ExpressionPtr bounds[3];
    int given = 0;
    bool slice = false;
    for (;;) {
      if (!IsOperator(":") && !IsOperator("]")) {
        bounds[given] = Conditional();
        if (IsOperator(",") && !slice) bounds[given] = TupleAfter(std::move(bounds[given]));
      }
      if (given == 2 || !Take(":")) break;
      slice = true;
      ++given;
    }
    Expect("]");
    if (slice) {
      return Make(Kind::kSlice, "", std::move(of), std::move(bounds[0]), std::move(bounds[1]),
                  std::move(bounds[2]));
    }
    if (bounds[0] == nullptr) Fail("[] without a place");
    return Make(Kind::kSubscript, "", std::move(of), std::move(bounds[0]));
  }

  ExpressionPtr Call(ExpressionPtr of) {
    ExpressionPtr made = Make(Kind::kCall, "", std::move(of));
    while (!IsOperator(")")) {
      const bool named = Here().kind == Token::Kind::kName && tokens_[at_ + 1].text == "=" &&
                         tokens_[at_ + 1].kind == Token::Kind::kOperator;
      if (named) {
        made->words.push_back(Here().text);
        at_ += 2;
      } else if (!made->words.empty()) {
        Fail("an argument without a name after one with");
      }
      Add(*made, Conditional());
      if (!Take(",")) break;
    }
    Expect(")");
    return made;
  }

  ExpressionPtr TupleAfter(ExpressionPtr first) {
    ExpressionPtr made = Make(Kind::kTuple, "", std::move(first));
    while (Take(",")) {
      if (IsOperator(")") || IsOperator("]") || Here().kind == Token::Kind::kEnd) break;
      Add(*made, Conditional());
    }
    return made;
  }

  ExpressionPtr Atom() {
    if (Here().kind == Token::Kind::kConstant) return Constant();
    if (Here().kind == Token::Kind::kName) return Name();
    if (Take("(")) {
      if (Take(")")) return Make(Kind::kTuple, "");
      ExpressionPtr inner = Conditional();
      if (IsOperator(",")) inner = TupleAfter(std::move(inner));
      Expect(")");
      return inner;
    }
    if (Take("[")) {
      ExpressionPtr made = Make(Kind::kList, "");
      while (!IsOperator("]")) {
        Add(*made, Conditional());
        if (!Take(",")) break;
      }
      Expect("]");
      return made;
    }
    if (!Take("{")) Fail();
    ExpressionPtr made = Make(Kind::kDict, "");
    while (!IsOperator("}")) {
      Add(*made, Conditional());
      Expect(":");
      Add(*made, Conditional());
      if (!Take(",")) break;
    }
    Expect("}");
    return made;
  }

  ExpressionPtr Constant() {
    ExpressionPtr made = Make(Kind::kConstant, "");
    made->value = tokens_[at_++].value;
    while (made->value.text() != nullptr && Here().kind == Token::Kind::kConstant &&
           Here().value.text() != nullptr) {  // 'a' 'b' is 'ab'
      made->value = PythonValue(*made->value.text() + *tokens_[at_++].value.text());
    }
    return made;
  }

  ExpressionPtr Name() {
    const std::string& name = Here().text;
    for (const char* const word : {"and", "or", "not", "in", "is", "if", "else", "for", "lambda",
                                   "while", "def", "class", "import", "yield", "await"}) {
      if (name == word) Fail();
    }
    ++at_;
    if (name == "True" || name == "False" || name == "None") {
      ExpressionPtr made = Make(Kind::kConstant, "");
      if (name != "None") made->value = PythonValue(name == "True");
      return made;
    }
    return Make(Kind::kName, name);
  }

  const std::vector<Token> tokens_;
  std::size_t at_{0};
  int open_{0};
};

}  // namespace

ExpressionPtr ParseExpression(std::string_view text) {
  if (text.size() > kLongestExpression) {
    throw Mistake("expression", fmt::format("{} characters", text.size()),
                  fmt::format("at most {}", kLongestExpression));
  }
  return ExpressionParser(text).Parse();
}

}  // namespace oca::robot::xacro
