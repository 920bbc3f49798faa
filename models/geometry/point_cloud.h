// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "oca/models/geometry/shape.h"

namespace oca::geometry {

inline constexpr std::size_t kMostCloudPoints = 1'000'000;  ///< of a cloud

/// Points of a file, in its frame, m:
///
///   .csv, .xyz  a table as CsvTable reads it: the columns named x, y and z, without names the
///               first three; other columns are ignored
///   .ply        ascii or binary of either byte order; `element vertex` with x, y, z of any scalar
///               type
///   .pcd        ascii, binary or binary_compressed; FIELDS with x, y, z
///
/// Points with a coordinate that is not finite, by which depth cameras say that they saw nothing,
/// are left out.
/// throws ModelError `file: ...` or `file:line: ...`: missing, above 100 MB, unknown extension or
///        kind, no such fields, a number that is none, fewer points than announced, no point at
///        all, more than kMostCloudPoints
std::vector<Eigen::Vector3d> LoadPointCloud(const std::filesystem::path& file);

/// A ball of `radius` m around each point.
Compound MakeCloud(std::span<const Eigen::Vector3d> points, double radius);

/// Heights above z = 0 of a file, as a block with a column a cell, `cell` m wide, about the origin:
/// the file's first row lies at the largest y, its first value at the smallest x.
///
///   .pgm  grey values, text (P2) or binary (P5), of 0 to `scale` m
///   .csv  heights in units of `scale` m, rows of equal length
///
/// A column reaches from z = -cell up to its height; equal neighbours in a row share one box.
/// throws ModelError as LoadPointCloud does, and for a negative height or a cell or scale that is
///        not positive
Compound LoadHeightmap(const std::filesystem::path& file, double cell, double scale);

}  // namespace oca::geometry
