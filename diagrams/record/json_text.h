// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>

namespace oca::record {

// JSON appended to a string without a tree in between: a recorder writes thousands a second.

/// All digits that the number has; null for NaN and infinity.
void AppendJson(std::string& out, double number);
/// Rounded to a millionth, without zeros at the end: enough for a picture.
void AppendShort(std::string& out, double number);
/// Quoted and escaped.
void AppendQuoted(std::string& out, std::string_view text);
/// {"x":...,"y":...,"z":...}, rounded as AppendShort does; so the next one.
void AppendXyz(std::string& out, const Eigen::Vector3d& vector);
/// {"x":...,"y":...,"z":...,"w":...}
void AppendQuaternion(std::string& out, const Eigen::Quaterniond& rotation);
/// [x,y,z] in full.
void AppendList(std::string& out, const Eigen::Vector3d& vector);
/// {"sec":...,"nsec":...}
void AppendTime(std::string& out, std::uint64_t nanoseconds);
/// In base64.
void AppendBase64(std::string& out, std::string_view bytes);

}  // namespace oca::record
