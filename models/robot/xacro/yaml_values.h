// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

/// What xacro.load_yaml makes of a YAML text: scalars mean what they mean to PyYAML (YAML 1.1:
/// `yes` is true, `1e3` a text), and `!degrees`, `!radians`, `!meters`, `!millimeters`, `!inches`
/// and `!foot` give numbers in radians and metres. Their texts are expressions, worked out by
/// `evaluate`. Aliases and merge keys count.
/// throws Mistake beginning with the line, for what is no YAML and for other tags
PythonValue ReadYamlValues(
    const std::string& text,
    const std::function<PythonValue(const std::string& expression)>& evaluate);

}  // namespace oca::robot::xacro
