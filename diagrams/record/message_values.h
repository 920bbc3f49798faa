// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>

namespace oca::record {

// Values of messages for viewers, appended as JSON.

/// Rounded to a millionth, without zeros at the end: enough for a picture; null for NaN and
/// infinity.
void AppendShort(std::string& out, double number);
/// {"x":...,"y":...,"z":...}, rounded as AppendShort does; so the next one.
void AppendXyz(std::string& out, const Eigen::Vector3d& vector);
/// {"x":...,"y":...,"z":...,"w":...}
void AppendQuaternion(std::string& out, const Eigen::Quaterniond& rotation);
/// {"sec":...,"nsec":...}
void AppendTime(std::string& out, std::uint64_t nanoseconds);
/// In base64.
void AppendBase64(std::string& out, std::string_view bytes);

}  // namespace oca::record
