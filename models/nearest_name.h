// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace oca::models {

/// The candidate with the smallest internal::EditDistance to `name`, the first of equals; "" if
/// none.
std::string NearestName(std::string_view name, std::span<const std::string> candidates);

/// What an unknown name may be meant as, for files in which unknown names are passed over but
/// misspelt ones refused: the nearest candidate if it is one or two edits away, else "".
std::string MisspeltName(std::string_view name, std::span<const std::string> candidates);

}  // namespace oca::models
