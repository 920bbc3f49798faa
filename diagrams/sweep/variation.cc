// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/variation.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/random.h"

namespace oca::sweep {
namespace {

std::string Trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Splits at the commas outside brackets and quotes.
std::vector<std::string> Split(const std::string& text) {
  std::vector<std::string> parts{""};
  int depth = 0;
  char quote = 0;
  for (const char letter : text) {
    if (quote != 0) {
      if (letter == quote) quote = 0;
    } else if (letter == '\'' || letter == '"') {
      quote = letter;
    } else if (letter == '[' || letter == '{' || letter == '(') {
      ++depth;
    } else if (letter == ']' || letter == '}' || letter == ')') {
      --depth;
    } else if (letter == ',' && depth == 0) {
      parts.emplace_back();
      continue;
    }
    parts.back() += letter;
  }
  for (std::string& part : parts) part = Trimmed(part);
  return parts;
}

/// The name before the bracket of `name(...)`; empty if it is none.
std::string CalledName(const std::string& spec) {
  const std::size_t open = spec.find('(');
  if (open == 0 || open == std::string::npos || spec.back() != ')') return "";
  const std::string name = spec.substr(0, open);
  const bool letters = name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos;
  return letters ? name : "";
}

}  // namespace

Variation Variation::Parse(const std::string& text) {
  Variation variation;
  variation.text_ = text;
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) variation.Refuse("has no '='");
  variation.path_ = Trimmed(text.substr(0, equals));
  const std::string spec = Trimmed(text.substr(equals + 1));
  if (variation.path_.empty()) variation.Refuse("has no PATH");
  if (variation.path_ == "simulator.seed") variation.Refuse("the seed is that of the sample");
  const std::string name = CalledName(spec);
  if (name.empty()) {
    variation.values_ = Split(spec);
    for (const std::string& value : variation.values_) {
      if (value.empty()) variation.Refuse("has a value of nothing");
    }
  } else {
    variation.ParseCall(name, Split(spec.substr(name.size() + 1, spec.size() - name.size() - 2)));
  }
  return variation;
}

void Variation::ParseCall(const std::string& name, const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    if (argument.empty()) Refuse("an argument is missing");
  }
  if (name == "uniform") {
    ParseUniform(arguments);
  } else if (name == "integers") {
    ParseIntegers(arguments);
  } else if (name == "choice") {
    kind_ = Kind::kChoice;
    values_ = arguments;
  } else {
    static const std::vector<std::string> kNames{"uniform", "integers", "choice"};
    Refuse(fmt::format("unknown '{}'{}", name, DidYouMean(name, kNames)));
  }
}

void Variation::ParseUniform(const std::vector<std::string>& arguments) {
  if (arguments.size() < 2 || arguments.size() > 3) Refuse("uniform takes two bounds and a step");
  kind_ = Kind::kUniform;
  lower_ = Number(arguments[0]);
  upper_ = Number(arguments[1]);
  if (upper_ < lower_) Refuse("the bounds are the wrong way round");
  if (arguments.size() == 2) return;
  if (!arguments[2].starts_with("step=")) Refuse("the third argument of uniform is step=...");
  kind_ = Kind::kSteps;
  step_ = Number(Trimmed(arguments[2].substr(5)));
  const double steps = (upper_ - lower_) / step_;
  if (!(step_ > 0.0) || !(steps < 1e15)) Refuse("the step is not positive, or much too small");
  count_ = static_cast<std::uint64_t>(std::floor(steps + 1e-9)) + 1;
}

void Variation::ParseIntegers(const std::vector<std::string>& arguments) {
  if (arguments.size() != 2) Refuse("integers takes two bounds");
  kind_ = Kind::kSteps;
  lower_ = Number(arguments[0]);
  upper_ = Number(arguments[1]);
  step_ = 1.0;
  if (lower_ != std::floor(lower_) || upper_ != std::floor(upper_)) Refuse("a bound is no integer");
  if (upper_ < lower_) Refuse("the bounds are the wrong way round");
  if (std::fabs(lower_) > 1e9 || std::fabs(upper_) > 1e9) Refuse("a bound is beyond 1e9");
  count_ = static_cast<std::uint64_t>(upper_ - lower_) + 1;
}

std::string Variation::Draw(std::uint64_t seed) const {
  models::Random random(models::Random::Seed(seed, path_));
  switch (kind_) {
    case Kind::kUniform:
      return fmt::format("{}", random.Uniform(lower_, upper_));
    case Kind::kSteps:  // 12 digits, as a person would write 0.4 + 4 * 0.05
      return fmt::format("{:.12g}", lower_ + step_ * static_cast<double>(random.Below(count_)));
    default:
      return values_[random.Below(values_.size())];
  }
}

void Variation::Refuse(const std::string& why) const {
  throw ConfigError(fmt::format(
      "--vary '{}': {}; expected PATH=VALUE,VALUE..., PATH=uniform(LOWER, UPPER[, step=STEP]), "
      "PATH=integers(LOWER, UPPER) or PATH=choice(VALUE, VALUE...)",
      text_, why));
}

double Variation::Number(const std::string& text) const {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || !std::isfinite(number)) {
    Refuse(fmt::format("'{}' is no number", text));
  }
  return number;
}

}  // namespace oca::sweep
