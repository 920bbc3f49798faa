// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "oca/diagrams/sampling/approach.h"
#include "oca/diagrams/sampling/distribution.h"
#include "oca/diagrams/sampling/task_geometry.h"
#include "oca/framework/dataflow/params.h"

namespace oca::sampling {

enum class SampledShape { kSphere, kBox, kCylinder, kCapsule };
inline std::span<const char* const> EnumNames(SampledShape) {
  static constexpr std::array kNames{"sphere", "box", "cylinder", "capsule"};
  return kNames;
}

/// Where obstacles that stand are drawn from: uniform in the space between two spheres.
struct ShellParams {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};
  Eigen::VectorXd radius{};
  static void Describe(Fields<ShellParams>& fields);
};

/// Section `sampling.obstacles`: obstacles that are added to those of the file.
struct RandomObstacleParams {
  Eigen::VectorXd count{};
  std::vector<SampledShape> shapes{};
  Eigen::VectorXd extent{};
  std::optional<ShellParams> shell{};
  std::optional<ApproachParams> approach{};
  static void Describe(Fields<RandomObstacleParams>& fields);
};

/// Draws obstacles of random shape, size and place.
///
/// An extent is a full width: the diameter of a sphere, cylinder or capsule, an edge of a box, the
/// length of a cylinder, the whole length of a capsule, of which the shorter of two draws is the
/// diameter. Rotations are uniform.
class RandomObstacles {
 public:
  /// Problems at `value`, section `sampling.obstacles`.
  RandomObstacles(const Value& value, Problems& problems);

  /// As entries of `obstacles` of a system that has them, all at `location`. They differ by `seed`
  /// alone.
  Value::List Draw(std::uint64_t seed, TaskGeometry& task, const Location& location) const;

 private:
  Value DrawOne(models::Random& random, int number, TaskGeometry& task,
                const Location& location) const;
  Value DrawShape(models::Random& random, SampledShape shape, const Location& location) const;

  RandomObstacleParams params_;
  Interval count_, extent_, radius_;
  Approach approach_{};
};

}  // namespace oca::sampling
