// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string_view>
#include <vector>

namespace oca::geometry::internal {

/// The points of a PCD file (ascii, binary or binary_compressed), finite or not. `text` is the
/// content of the file.
///
/// throws ModelError `file:line: ...`, or without a line for what is behind a binary header: no
///        PCD, a field of no scalar type, no x, y, z, fewer or more points than announced or than
///        WIDTH times HEIGHT, damaged data
/// source Point Cloud Library, The PCD file format
std::vector<Eigen::Vector3d> ReadPcd(const std::filesystem::path& file, std::string_view text);

}  // namespace oca::geometry::internal
