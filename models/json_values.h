// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

namespace oca::models::internal {

// JSON appended to a string without a tree in between: a recorder writes thousands a second.

/// The fewest digits that read back as the same bits, `-0.0` for the zero with a sign; null for NaN
/// and infinity.
void AppendJson(std::string& out, double number);
/// Quoted and escaped; U+FFFD in place of what is no UTF-8.
void AppendQuoted(std::string& out, std::string_view text);
/// [x,y,z], each as AppendJson.
void AppendList(std::string& out, const Eigen::Vector3d& vector);

}  // namespace oca::models::internal
