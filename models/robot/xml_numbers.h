// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace oca::robot {

/// Numbers separated by white space, read alike in every locale; nothing if the text is anything
/// else or holds a number that is not finite.
std::optional<std::vector<double>> ParseFiniteNumbers(std::string_view text);

}  // namespace oca::robot
