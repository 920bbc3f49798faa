// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/models/robot/xacro/budget.h"
#include "oca/models/robot/xacro/expression.h"
#include "oca/models/robot/xacro/functions.h"
#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

/// What an expression sees from where it stands.
class Surroundings {
 public:
  virtual ~Surroundings() = default;
  /// The property of that name here or further out; nullptr if there is none.
  virtual const PythonValue* Property(const std::string& name) = 0;
  /// What `name.` stands for after an include with ns="name"; nullptr if that is none.
  virtual Surroundings* Namespace(const std::string& name) = 0;
  /// xacro.NAME(...), of kXacroFunctions.
  virtual PythonValue CallXacro(const std::string& name, const Arguments& arguments) = 0;
  /// All properties that it sees, for messages.
  virtual std::vector<std::string> PropertyNames() const = 0;
};

/// The value of an expression. throws Mistake
PythonValue Evaluate(const Expression& expression, Surroundings& in, Budget& budget);

/// What xacro makes of the text of a property or parameter: a number or boolean if it is one; else
/// the text, without single quotes around it.
PythonValue LiteralOf(const std::string& text);

}  // namespace oca::robot::xacro
