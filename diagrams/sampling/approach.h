// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>

#include "oca/diagrams/sampling/distribution.h"
#include "oca/diagrams/sampling/task_geometry.h"
#include "oca/framework/dataflow/params.h"

namespace oca::sampling {

/// What an obstacle does that comes.
enum class Manner {
  kStraight,      ///< flies by
  kTurning,       ///< flies by on an arc, turned with `bend`
  kCircling,      ///< goes round and round, on a circle of radius `distance`
  kAccelerating,  ///< from `speed` on gets faster by `acceleration`
  kOscillating,   ///< to and fro through the aim, by `distance`, with `speed` at the aim
  kStopping,      ///< stops at the aim
  kFeint,         ///< turns back halfway or later, and comes again
  kHand,          ///< reaches to the aim and pulls back, twice, `speed` at most
  kFalling,       ///< falls from rest, from `distance` above
  kJaws,          ///< four boxes, from four sides, which meet at the aim and stay
  kBehind         ///< is in sight for `sight` before it is at the aim
};
inline std::span<const char* const> EnumNames(Manner) {
  static constexpr std::array kNames{"straight",    "turning",  "circling", "accelerating",
                                     "oscillating", "stopping", "feint",    "hand",
                                     "falling",     "jaws",     "behind"};
  return kNames;
}

/// How obstacles come that move. Each aims at a point between the origins of the robot's links from
/// `from_link` on, as requested at the instant when it would be there; it comes from a uniformly
/// random direction, and goes on beyond.
struct ApproachParams {
  Manner manner{Manner::kStraight};
  Eigen::VectorXd speed{};
  Eigen::VectorXd distance{};
  Eigen::VectorXd start{};
  std::string from_link{};
  std::optional<Eigen::VectorXd> bend{};
  std::optional<Eigen::VectorXd> acceleration{};
  std::optional<Eigen::VectorXd> sight{};
  static void Describe(Fields<ApproachParams>& fields);
};

Eigen::Vector3d DrawDirection(models::Random& random);

/// A tree all of which stands at one place.
class Tree {
 public:
  explicit Tree(const Location& location) : location_(location) {}

  Value Number(double x) const { return Value(x, location_); }
  Value Text(const std::string& text) const { return Value(text, location_); }
  Value Flag(bool flag) const { return Value(flag, location_); }
  Value List(const Eigen::Ref<const Eigen::VectorXd>& numbers) const;
  Value List(Value::List list) const { return Value(std::move(list), location_); }
  Value Map(std::initializer_list<std::pair<const char*, Value>> entries) const;

 private:
  const Location& location_;
};

/// A motion that was drawn, and where it starts.
struct Coming {
  Eigen::Vector3d p_WO{Eigen::Vector3d::Zero()};
  Value motion{};
  std::optional<double> appear{};  ///< s
};

/// Draws how obstacles come.
class Approach {
 public:
  Approach() = default;
  /// Problems at `value`, the section `approach` that was read into `params`.
  Approach(const ApproachParams& params, const Value& value, const std::string& where,
           Problems& problems);

  bool jaws() const { return params_.manner == Manner::kJaws; }
  Coming Draw(models::Random& random, TaskGeometry& task, const Location& location) const;
  /// Four boxes as entries of `obstacles`; `extent` is of their faces, m.
  Value::List DrawJaws(models::Random& random, int number, const Interval& extent,
                       TaskGeometry& task, const Location& location) const;

 private:
  struct Course;
  Course DrawCourse(models::Random& random, TaskGeometry& task) const;
  double SpanOf(const Course& course) const;
  Value MotionOf(const Course& course, models::Random& random, const Tree& tree,
                 Coming& coming) const;
  Value Turning(const Course& course, models::Random& random, const Tree& tree,
                Coming& coming) const;
  Value Circling(const Course& course, models::Random& random, const Tree& tree,
                 Coming& coming) const;
  Value Oscillating(const Course& course, const Tree& tree, Coming& coming) const;
  Value Reaches(const Course& course, const Tree& tree) const;
  Value Feint(const Course& course, models::Random& random, const Tree& tree) const;

  ApproachParams params_;
  Interval speed_, distance_, start_, bend_, acceleration_, sight_;
};

}  // namespace oca::sampling
