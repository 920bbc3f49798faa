// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "oca/models/robot/xacro/budget.h"
#include "oca/models/robot/xacro/evaluator.h"

namespace oca::robot::test {

/// Surroundings of an expression: properties by name.
class StubProperties final : public xacro::Surroundings {
 public:
  const xacro::PythonValue* Property(const std::string& name) override {
    const auto found = values.find(name);
    return found == values.end() ? nullptr : &found->second;
  }
  Surroundings* Namespace(const std::string& /*name*/) override { return nullptr; }
  xacro::PythonValue CallXacro(const std::string& name,
                               const xacro::Arguments& arguments) override {
    return xacro::PythonValue(name + ":" + xacro::ToText(arguments.values.at(0)));
  }
  std::vector<std::string> PropertyNames() const override {
    std::vector<std::string> names;
    for (const auto& entry : values) names.push_back(entry.first);
    return names;
  }
  std::map<std::string, xacro::PythonValue> values;
};

/// The value of an expression.
inline xacro::PythonValue ValueOf(const std::string& text, StubProperties properties = {}) {
  xacro::Budget budget;
  return Evaluate(*xacro::ParseExpression(text), properties, budget);
}

}  // namespace oca::robot::test
