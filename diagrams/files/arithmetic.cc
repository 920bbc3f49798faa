// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/arithmetic.h"

#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <numbers>

#include "oca/models/file_cache.h"

namespace oca::files {
namespace {

double Not(double x) { return x == 0.0 ? 1.0 : 0.0; }

/// Making one takes longer than most that it parses.
struct Prepared {
  Prepared() {
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineConst("deg", std::numbers::pi / 180.0);
    parser.DefineInfixOprt("!", Not);
    constants = parser.GetConst();
  }
  mu::Parser parser;
  mu::valmap_type constants;  // of every expression
};

ArithmeticResult Parse(const std::string& expression,
                       const std::map<std::string, double>& numbers) {
  static thread_local Prepared prepared;
  mu::Parser& parser = prepared.parser;
  try {
    parser.ClearConst();
    for (const auto& [name, number] : prepared.constants) parser.DefineConst(name, number);
    parser.SetExpr(expression);
    for (const auto& [name, number] : numbers) parser.DefineConst(name, number);
    const double number = parser.Eval();
    return {number, parser.GetNumResults()};
  } catch (const mu::Parser::exception_type& error) {
    const bool unknown = error.GetCode() == mu::ecUNASSIGNABLE_TOKEN;
    throw ArithmeticError(error.GetMsg(), unknown ? error.GetToken() : "");
  }
}

}  // namespace

bool IsName(const std::string& text) {
  if (text.empty() || (std::isalpha(static_cast<unsigned char>(text[0])) == 0 && text[0] != '_')) {
    return false;
  }
  for (const unsigned char c : text) {
    if (std::isalnum(c) == 0 && c != '_') return false;
  }
  return true;
}

bool IsReserved(const std::string& name) {
  static const mu::Parser parser;
  return name == "pi" || name == "deg" || name == "true" || name == "false" ||
         parser.GetFunDef().contains(name);
}

std::set<std::string> NamesIn(const std::string& expression) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < expression.size();) {
    std::size_t end = i;
    while (end < expression.size() &&
           (std::isalnum(static_cast<unsigned char>(expression[end])) != 0 ||
            expression[end] == '_')) {
      ++end;
    }
    if (const std::string word = expression.substr(i, end - i); IsName(word)) names.insert(word);
    i = std::max(end, i + 1);
  }
  return names;
}

ArithmeticResult Calculate(const std::string& expression,
                           const std::map<std::string, double>& numbers) {
  std::string form;
  for (const auto& [name, number] : numbers) {
    form += name;
    form.append(1, '\0').append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  return *models::MakeOnce<ArithmeticResult>(expression, form,
                                             [&] { return Parse(expression, numbers); });
}

}  // namespace oca::files
