// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include "framework/error.h"
#include "systems/obstacle_motion.h"

namespace oca::systems {
namespace {

std::string_view Trimmed(std::string_view text) {
  constexpr const char* kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

std::vector<std::string_view> SplitAtCommas(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t comma = line.find(','); comma != std::string_view::npos;
       comma = line.find(',')) {
    cells.push_back(Trimmed(line.substr(0, comma)));
    line.remove_prefix(comma + 1);
  }
  cells.push_back(Trimmed(line));
  return cells;
}

double ReadCell(std::string_view cell, const std::string& where) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(number)) {
    throw ConfigError(fmt::format("{}: got '{}'; expected a finite number", where, cell));
  }
  return number;
}

}  // namespace

std::vector<WaypointParams> ReadWaypoints(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw ConfigError(file + ": cannot be read; expected a CSV file");
  const std::vector<std::string_view> with_rotation{"time", "x", "y", "z", "roll", "pitch", "yaw"};
  const std::vector<std::string_view> without(with_rotation.begin(), with_rotation.begin() + 4);
  std::string line;
  std::getline(stream, line);
  const auto columns = SplitAtCommas(line);
  const bool rotates = columns == with_rotation;
  const std::size_t count = columns.size();
  if (!rotates && columns != without) {
    throw ConfigError(
        fmt::format("{}:1: columns; got '{}'; expected time,x,y,z or "
                    "time,x,y,z,roll,pitch,yaw",
                    file, std::string_view(line).substr(0, 60)));
  }
  std::vector<WaypointParams> waypoints;
  for (int number = 2; std::getline(stream, line); ++number) {
    if (Trimmed(line).empty()) continue;
    const std::string where = fmt::format("{}:{}", file, number);
    const auto cells = SplitAtCommas(line);
    if (cells.size() != count) {
      throw ConfigError(fmt::format("{}: got {} cells; expected {}", where, cells.size(), count));
    }
    const auto vector_at = [&](std::size_t i) -> Eigen::Vector3d {
      return {ReadCell(cells[i], where), ReadCell(cells[i + 1], where),
              ReadCell(cells[i + 2], where)};
    };
    waypoints.push_back({ReadCell(cells[0], where), vector_at(1), {}});
    if (rotates) waypoints.back().rpy = vector_at(4);
  }
  return waypoints;
}

}  // namespace oca::systems
