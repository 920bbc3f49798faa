// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/waypoints.h"

#include <fmt/format.h>

#include "oca/models/csv_table.h"
#include "oca/models/error.h"
#include "oca/models/file_cache.h"

namespace oca::motion {
namespace {

std::vector<Waypoint> ReadWaypointTable(const std::string& file) {
  models::CsvTable table(file);
  std::vector<std::size_t> columns = table.Columns({"time", "x", "y", "z"});
  if (columns.empty()) {
    throw models::ModelError(fmt::format(
        "{}: names of columns; got none; expected time,x,y,z or time,x,y,z,roll,pitch,yaw",
        table.where()));
  }
  const bool rotates = table.Has("roll") || table.Has("pitch") || table.Has("yaw");
  if (rotates) {
    const auto more = table.Columns({"roll", "pitch", "yaw"});
    columns.insert(columns.end(), more.begin(), more.end());
  }
  const auto vector_at = [&](std::size_t i) -> Eigen::Vector3d {
    return {table.Number(columns[i]), table.Number(columns[i + 1]), table.Number(columns[i + 2])};
  };
  std::vector<Waypoint> waypoints;
  while (table.NextRow()) {
    waypoints.push_back({table.Number(columns[0]), vector_at(1), {}});
    if (rotates) waypoints.back().rpy = vector_at(4);
  }
  return waypoints;
}

}  // namespace

std::vector<Waypoint> ReadWaypoints(const std::string& file) {
  return *models::ReadOnce<std::vector<Waypoint>>(file, "waypoints",
                                                  [&] { return ReadWaypointTable(file); });
}

}  // namespace oca::motion
