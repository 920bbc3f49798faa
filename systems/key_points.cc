// SPDX-License-Identifier: BSD-3-Clause
#include "systems/key_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "framework/error.h"
#include "systems/csv_table.h"

namespace oca::systems {
namespace {

/// How many columns hold positions, velocities and accelerations.
struct Columns {
  Eigen::Index joints{0};
  bool velocities{false};
  bool accelerations{false};
  Eigen::Index count() const { return 1 + joints * (1 + velocities + accelerations); }
};

/// From the line of names.
Columns ReadNames(const std::vector<std::string_view>& cells, const std::string& where) {
  std::string kinds;
  for (const std::string_view name : cells) kinds += name.empty() ? ' ' : name.front();
  const auto joints = static_cast<Eigen::Index>(std::count(kinds.begin(), kinds.end(), 'p'));
  Columns columns{joints, kinds.find('v') != std::string::npos,
                  kinds.find('a') != std::string::npos};
  std::string expected = "t" + std::string(joints, 'p');
  if (columns.velocities) expected += std::string(joints, 'v');
  if (columns.accelerations) expected += std::string(joints, 'a');
  if (joints > 0 && kinds == expected) return columns;
  throw ConfigError(fmt::format(
      "{}: names of columns; got {} columns; expected time, p1..pn, then v1..vn and a1..an or none",
      where, cells.size()));
}

KeyPoint ReadRow(const CsvTable& table, const Columns& columns) {
  if (static_cast<Eigen::Index>(table.cells().size()) != columns.count()) {
    throw ConfigError(fmt::format("{}: wrong length; got {} numbers; expected {}", table.where(),
                                  table.cells().size(), columns.count()));
  }
  std::size_t column = 0;
  const auto vector = [&] {
    Eigen::VectorXd values(columns.joints);
    for (double& value : values) value = table.Number(column++);
    return values;
  };
  KeyPoint point;
  point.time = table.Number(column++);
  point.position = vector();
  if (columns.velocities) point.velocity = vector();
  if (columns.accelerations) point.acceleration = vector();
  return point;
}

void CheckVector(const std::string& where, const Eigen::VectorXd& values, Eigen::Index size) {
  if (values.size() != size || size == 0) {
    throw ConfigError(fmt::format("{}: wrong length; got {} numbers; expected {}", where,
                                  values.size(),
                                  size == 0 ? "at least one" : std::to_string(size)));
  }
  if (!values.allFinite()) {
    throw ConfigError(
        fmt::format("{}: not finite; got a NaN or an infinity; expected numbers", where));
  }
}

void CheckPoints(const std::vector<KeyPoint>& points, const std::string& list) {
  if (points.empty()) {
    throw ConfigError(fmt::format("{}: empty; got no point; expected at least one", list));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const KeyPoint& point = points[i];
    const std::string where = fmt::format("{}[{}]", list, i);
    if (!std::isfinite(point.time)) {
      throw ConfigError(
          fmt::format("{}.time: not finite; got {}; expected a finite number", where, point.time));
    }
    if (i > 0 && !(point.time > points[i - 1].time)) {
      throw ConfigError(
          fmt::format("{}.time: not later than the point before; got {}; expected > {}", where,
                      point.time, points[i - 1].time));
    }
    const Eigen::Index joints = points.front().position.size();
    CheckVector(where + ".position", point.position, joints);
    if (point.velocity) CheckVector(where + ".velocity", *point.velocity, joints);
    if (point.acceleration) CheckVector(where + ".acceleration", *point.acceleration, joints);
  }
}

}  // namespace

void KeyPoint::Describe(Fields<KeyPoint>& fields) {
  fields.Add("time", &KeyPoint::time, "s", "when the point is passed").Required();
  fields.Add("position", &KeyPoint::position, "", "one number a joint").Required();
  fields.Add("velocity", &KeyPoint::velocity, "", "one number a joint; absent: 0");
  fields.Add("acceleration", &KeyPoint::acceleration, "", "one number a joint; absent: 0");
}

std::vector<KeyPoint> ReadKeyPoints(const std::string& path) {
  CsvTable table(path);
  std::vector<KeyPoint> points;
  Columns columns;
  while (table.NextRow()) {
    if (columns.joints == 0) {
      if (table.cells().front() == "time") {
        columns = ReadNames(table.cells(), table.where());
        continue;
      }
      columns.joints = static_cast<Eigen::Index>(table.cells().size()) - 1;
    }
    points.push_back(ReadRow(table, columns));
  }
  return points;
}

std::vector<KeyPoint> KeyPointsFrom(const std::vector<KeyPoint>& key_points,
                                    const std::string& file) {
  if (file.empty()) {
    CheckPoints(key_points, "key_points");
    return key_points;
  }
  if (!key_points.empty()) {
    throw ConfigError("file: given twice; got key_points too; expected one of the two");
  }
  std::vector<KeyPoint> points = ReadKeyPoints(file);
  CheckPoints(points, file);
  return points;
}

}  // namespace oca::systems
