// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/point_cloud.h"

#include <fmt/format.h>

#include <string>

#include "oca/models/csv_table.h"
#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/file_cache.h"
#include "oca/models/geometry/pcd_file.h"
#include "oca/models/geometry/ply_file.h"
#include "oca/models/table_text.h"

namespace oca::geometry {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

std::vector<Vector3d> ReadTable(const fs::path& file) {
  models::CsvTable table(file);
  std::vector<std::size_t> columns = table.Columns({"x", "y", "z"});
  if (columns.empty()) columns = {0, 1, 2};
  std::vector<Vector3d> points;
  while (table.NextRow()) {
    if (table.cells().size() < 3) {
      throw models::ModelError(fmt::format("{}: no point; got {} values; expected x, y and z",
                                           table.where(), table.cells().size()));
    }
    points.emplace_back(table.AnyNumber(columns[0]), table.AnyNumber(columns[1]),
                        table.AnyNumber(columns[2]));
  }
  return points;
}

std::vector<Vector3d> ReadPoints(const fs::path& file) {
  const std::string kind = models::internal::Lower(file.extension().string());
  if (kind == ".csv" || kind == ".xyz") return ReadTable(file);
  if (kind == ".pcd") return internal::ReadPcd(file, models::ReadFile(file));
  if (kind == ".ply") {
    const std::string text = models::ReadFile(file);
    return internal::ReadPly(file, text, internal::PlyPart::kVertices).vertices;
  }
  models::internal::RefuseText(file, 0, "extension", "'" + kind + "'", ".csv, .xyz, .ply or .pcd");
}

std::vector<Vector3d> ReadCloud(const fs::path& file) {
  std::vector<Vector3d> points = ReadPoints(file);
  std::erase_if(points, [](const Vector3d& p) { return !p.allFinite(); });
  points.shrink_to_fit();
  if (points.empty()) {
    models::internal::RefuseText(file, 0, "holds no point", "none", "at least one");
  }
  if (points.size() > kMostCloudPoints) {
    models::internal::RefuseText(file, 0, "points", fmt::format("{}", points.size()),
                                 fmt::format("at most {}; thin the cloud out, or make an octree "
                                             "of it",
                                             kMostCloudPoints));
  }
  return points;
}

}  // namespace

std::vector<Vector3d> LoadPointCloud(const fs::path& file) {
  return *models::ReadOnce<std::vector<Vector3d>>(file, "cloud", [&] { return ReadCloud(file); });
}

Compound MakeCloud(std::span<const Vector3d> points, double radius) {
  Compound cloud;
  cloud.parts.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    cloud.parts[i].X_SP.translation() = points[i];
    cloud.parts[i].shape = Sphere{radius};
  }
  return cloud;
}

}  // namespace oca::geometry
