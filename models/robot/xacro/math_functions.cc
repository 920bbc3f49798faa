// SPDX-License-Identifier: BSD-3-Clause
// Python's module math, of functions.h.
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "oca/models/robot/xacro/arithmetic.h"
#include "oca/models/robot/xacro/functions.h"

namespace oca::robot::xacro {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

using Unary = double (*)(double);
const std::map<std::string, Unary>& UnaryFunctions() {
  static const std::map<std::string, Unary> functions = {
      {"sin", [](double x) { return std::sin(x); }},
      {"cos", [](double x) { return std::cos(x); }},
      {"tan", [](double x) { return std::tan(x); }},
      {"asin", [](double x) { return std::asin(x); }},
      {"acos", [](double x) { return std::acos(x); }},
      {"atan", [](double x) { return std::atan(x); }},
      {"sinh", [](double x) { return std::sinh(x); }},
      {"cosh", [](double x) { return std::cosh(x); }},
      {"tanh", [](double x) { return std::tanh(x); }},
      {"sqrt", [](double x) { return std::sqrt(x); }},
      {"exp", [](double x) { return std::exp(x); }},
      {"log10", [](double x) { return x > 0.0 ? std::log10(x) : kUndefined; }},
      {"log2", [](double x) { return x > 0.0 ? std::log2(x) : kUndefined; }},
      {"fabs", [](double x) { return std::fabs(x); }},
      {"radians", [](double x) { return x * kDegree; }},
      {"degrees", [](double x) { return x * (180.0 / std::numbers::pi); }},
  };
  return functions;
}

using Binary = double (*)(double, double);
const std::map<std::string, Binary>& BinaryFunctions() {
  static const std::map<std::string, Binary> functions = {
      {"atan2", [](double y, double x) { return std::atan2(y, x); }},
      {"hypot", [](double x, double y) { return std::hypot(x, y); }},
      {"fmod", [](double x, double y) { return std::fmod(x, y); }},
      {"copysign", [](double x, double y) { return std::copysign(x, y); }},
      {"pow",
       [](double x, double y) { return Calculate(PythonValue(x), "**", PythonValue(y)).number(); }},
  };
  return functions;
}

/// `number`, of arguments that were numbers. throws Mistake if a function has no value there
PythonValue Defined(std::string_view what, double number, bool finite) {
  if (finite && !std::isfinite(number)) {
    throw Mistake(what, "an argument for which it has no value", "another one");
  }
  return PythonValue(number);
}

PythonValue Logarithm(const Arguments& arguments) {
  CheckCount("log()", arguments, 1, 2);
  const double number = NumberArgument("log()", arguments.values[0]);
  double value = number > 0.0 ? std::log(number) : kUndefined;
  if (arguments.values.size() == 2) {
    const double base = NumberArgument("log()", arguments.values[1]);
    value /= base > 0.0 && base != 1.0 ? std::log(base) : kUndefined;
  }
  return Defined("log()", value, true);
}

}  // namespace

std::vector<std::string> MathFunctions() {
  std::vector<std::string> names{"log"};
  for (const auto& entry : UnaryFunctions()) names.push_back(entry.first);
  for (const auto& entry : BinaryFunctions()) names.push_back(entry.first);
  return names;
}

std::optional<PythonValue> CallMath(const std::string& name, const Arguments& arguments) {
  const std::string what = name + "()";
  if (name == "log") return Logarithm(arguments);
  const auto one = UnaryFunctions().find(name);
  const auto two = BinaryFunctions().find(name);
  if (one == UnaryFunctions().end() && two == BinaryFunctions().end()) return std::nullopt;
  const std::size_t count = one != UnaryFunctions().end() ? 1 : 2;
  CheckCount(what, arguments, count, count);
  const double first = NumberArgument(what, arguments.values[0]);
  if (count == 1) return Defined(what, one->second(first), std::isfinite(first));
  const double second = NumberArgument(what, arguments.values[1]);
  return Defined(what, two->second(first, second), std::isfinite(first) && std::isfinite(second));
}

double NumberArgument(std::string_view what, const PythonValue& value) {
  if (!value.is_number()) throw Mistake(what, Shown(value), "a number");
  return value.number();
}

std::optional<double> ConstantNamed(std::string_view name) {
  if (name == "pi") return std::numbers::pi;
  if (name == "e") return std::numbers::e;
  if (name == "tau") return 2.0 * std::numbers::pi;
  if (name == "inf") return std::numeric_limits<double>::infinity();
  if (name == "nan") return kUndefined;
  return std::nullopt;
}

}  // namespace oca::robot::xacro
