// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <string_view>

#include "framework/error.h"
#include "systems/csv_table.h"
#include "systems/obstacle_motion.h"

namespace oca::systems {

std::vector<WaypointParams> ReadWaypoints(const std::string& file) {
  constexpr const char* kExpected = "expected time,x,y,z or time,x,y,z,roll,pitch,yaw";
  const std::vector<std::string_view> with_rotation{"time", "x", "y", "z", "roll", "pitch", "yaw"};
  const std::vector<std::string_view> without(with_rotation.begin(), with_rotation.begin() + 4);
  CsvTable table(file);
  if (!table.NextRow()) {
    throw ConfigError(fmt::format("{}: names of columns; got none; {}", file, kExpected));
  }
  const std::size_t count = table.cells().size();
  const bool rotates = table.cells() == with_rotation;
  if (!rotates && table.cells() != without) {
    throw ConfigError(
        fmt::format("{}: names of columns; got {} others; {}", table.where(), count, kExpected));
  }
  const auto vector_at = [&table](std::size_t i) -> Eigen::Vector3d {
    return {table.Number(i), table.Number(i + 1), table.Number(i + 2)};
  };
  std::vector<WaypointParams> waypoints;
  while (table.NextRow()) {
    if (table.cells().size() != count) {
      throw ConfigError(fmt::format("{}: wrong length; got {} numbers; expected {}", table.where(),
                                    table.cells().size(), count));
    }
    waypoints.push_back({table.Number(0), vector_at(1), {}});
    if (rotates) waypoints.back().rpy = vector_at(4);
  }
  return waypoints;
}

}  // namespace oca::systems
