// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/key_points.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>
#include <string_view>

#include "oca/models/csv_table.h"
#include "oca/models/error.h"
#include "oca/models/file_cache.h"

namespace oca::motion {
namespace {

using Numbers = std::vector<std::size_t>;

/// Where the time and the positions, velocities and accelerations of all joints are.
struct Columns {
  std::size_t time{0};
  Numbers positions, velocities, accelerations;
};

/// The column of each joint, of names that are a word or its first letter and the joint's number,
/// as p1 or position[0]; empty if there are none.
Numbers Numbered(const models::CsvTable& table, std::string_view word) {
  const char letter = word.front();
  std::map<std::size_t, std::size_t> columns;
  const auto& names = table.names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string_view name = names[i];
    const bool bracketed = name.ends_with(']');
    if (bracketed) name.remove_suffix(1);
    const std::size_t last = name.find_last_not_of("0123456789");
    const std::string_view digits = name.substr(last + 1);
    if (digits.empty() || digits.size() > 6) continue;
    std::string before(name.substr(0, last + 1));
    if (bracketed != before.ends_with('[')) continue;
    if (bracketed || before.ends_with('_')) before.pop_back();
    std::transform(before.begin(), before.end(), before.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (before != word && before != word.substr(0, 1)) continue;
    std::size_t number = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (columns.emplace(number, i).second) continue;
    throw models::ModelError(fmt::format(
        "{}: names of columns; got two with number {}; expected each once", table.where(), number));
  }
  Numbers ordered;
  for (const auto& [number, column] : columns) {
    if (ordered.empty() ? number <= 1 : number == columns.begin()->first + ordered.size()) {
      ordered.push_back(column);
      continue;
    }
    throw models::ModelError(
        fmt::format("{}: names of columns; got {}{} without those before; expected "
                    "numbers from 0 or 1 on",
                    table.where(), letter, number));
  }
  return ordered;
}

Columns FindColumns(models::CsvTable& table, const std::vector<std::string>& joints) {
  Columns columns;
  std::vector<std::string> wanted{"time"};
  wanted.insert(wanted.end(), joints.begin(), joints.end());
  const Numbers found = table.Columns(wanted);
  if (!joints.empty() && found.empty()) {
    throw models::ModelError(
        fmt::format("{}: names of columns; got none; expected time and those of "
                    "`joints`",
                    table.where()));
  }
  if (!found.empty()) columns.time = found.front();
  if (!joints.empty()) {
    columns.positions.assign(found.begin() + 1, found.end());
  } else if (found.empty()) {
    columns.positions.resize(table.width() == 0 ? 0 : table.width() - 1);
    std::iota(columns.positions.begin(), columns.positions.end(), std::size_t{1});
  } else {
    columns.positions = Numbered(table, "position");
    columns.velocities = Numbered(table, "velocity");
    columns.accelerations = Numbered(table, "acceleration");
    const std::size_t count = columns.positions.size();
    const auto fits = [&](const Numbers& rates) { return rates.empty() || rates.size() == count; };
    if (count == 0 || !fits(columns.velocities) || !fits(columns.accelerations)) {
      throw models::ModelError(fmt::format(
          "{}: names of columns; got {} positions, {} velocities, {} accelerations; expected time, "
          "p1..pn, then v1..vn and a1..an or none; or `joints`, the names of the columns of "
          "positions in order",
          table.where(), count, columns.velocities.size(), columns.accelerations.size()));
    }
  }
  return columns;
}

Eigen::VectorXd VectorAt(const models::CsvTable& table, const Numbers& columns) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    values[static_cast<Eigen::Index>(i)] = table.Number(columns[i]);
  }
  return values;
}

void CheckVector(const std::string& where, const Eigen::VectorXd& values, Eigen::Index size) {
  if (values.size() != size || size == 0) {
    throw models::ModelError(fmt::format("{}: wrong length; got {} numbers; expected {}", where,
                                         values.size(),
                                         size == 0 ? "at least one" : std::to_string(size)));
  }
  if (!values.allFinite()) {
    throw models::ModelError(
        fmt::format("{}: not finite; got a NaN or an infinity; expected numbers", where));
  }
}

std::vector<KeyPoint> ReadKeyPointTable(const std::string& path,
                                        const std::vector<std::string>& joints) {
  models::CsvTable table(path);
  const Columns columns = FindColumns(table, joints);
  std::vector<KeyPoint> points;
  while (table.NextRow()) {
    if (columns.positions.empty()) {
      throw models::ModelError(fmt::format(
          "{}: wrong length; got 1 value; expected a time and positions", table.where()));
    }
    KeyPoint& point = points.emplace_back();
    point.time = table.Number(columns.time);
    point.position = VectorAt(table, columns.positions);
    if (!columns.velocities.empty()) point.velocity = VectorAt(table, columns.velocities);
    if (!columns.accelerations.empty()) {
      point.acceleration = VectorAt(table, columns.accelerations);
    }
  }
  return points;
}

}  // namespace

std::vector<KeyPoint> ReadKeyPoints(const std::string& path,
                                    const std::vector<std::string>& joints) {
  return *models::ReadOnce<std::vector<KeyPoint>>(
      path, fmt::format("key points\n{}", fmt::join(joints, "\n")),
      [&] { return ReadKeyPointTable(path, joints); });
}

void CheckKeyPoints(const std::vector<KeyPoint>& points, const std::string& where) {
  if (points.empty()) {
    throw models::ModelError(fmt::format("{}: empty; got no point; expected at least one", where));
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const KeyPoint& point = points[i];
    const std::string at = fmt::format("{}[{}]", where, i);
    if (!std::isfinite(point.time)) {
      throw models::ModelError(
          fmt::format("{}.time: not finite; got {}; expected a finite number", at, point.time));
    }
    if (i > 0 && !(point.time > points[i - 1].time)) {
      throw models::ModelError(
          fmt::format("{}.time: not later than the point before; got {}; expected > {}", at,
                      point.time, points[i - 1].time));
    }
    const Eigen::Index joints = points.front().position.size();
    CheckVector(at + ".position", point.position, joints);
    if (const double far = point.position.cwiseAbs().maxCoeff(); far > kFarthestPosition) {
      throw models::ModelError(fmt::format(
          "{}.position: too far out; got {}; expected at most {:g}", at, far, kFarthestPosition));
    }
    if (point.velocity) CheckVector(at + ".velocity", *point.velocity, joints);
    if (point.acceleration) CheckVector(at + ".acceleration", *point.acceleration, joints);
  }
}

}  // namespace oca::motion
