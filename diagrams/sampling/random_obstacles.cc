// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sampling/random_obstacles.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace oca::sampling {
namespace {

using Eigen::Vector3d;

// Uniform rotation [x, y, z, w]. source Shoemake, Graphics Gems III, 1992, p. 124
Eigen::Vector4d DrawRotation(models::Random& random) {
  const double share = random.Unit();
  const double a = random.Uniform(-std::numbers::pi, std::numbers::pi);
  const double b = random.Uniform(-std::numbers::pi, std::numbers::pi);
  const double r = std::sqrt(1.0 - share);
  const double s = std::sqrt(share);
  return Eigen::Vector4d(r * std::sin(a), r * std::cos(a), s * std::sin(b), s * std::cos(b))
      .normalized();
}

}  // namespace

void ShellParams::Describe(Fields<ShellParams>& fields) {
  fields.Add("centre", &ShellParams::centre, "m", "in the world").Required();
  fields.Add("radius", &ShellParams::radius, "m", "of the inner and the outer sphere").Required();
}

void RandomObstacleParams::Describe(Fields<RandomObstacleParams>& fields) {
  using P = RandomObstacleParams;
  fields.Add("count", &P::count, "", "how many, least and most").Required();
  fields.Add("shapes", &P::shapes, "", "kinds, each as likely").Required();
  fields.Add("extent", &P::extent, "m", "full width along an axis, least and largest").Required();
  fields.Add("shell", &P::shell, "", "where they stand");
  fields.Add("approach", &P::approach, "", "how they come, instead of standing");
}

RandomObstacles::RandomObstacles(const Value& value, Problems& problems) {
  const std::string where = "sampling.obstacles";
  Problems own;
  ReadFields(value, FieldsOf<RandomObstacleParams>(), where, &params_, own);
  if (own.empty()) {
    const auto read = [&](const Eigen::VectorXd& pair, double least, const Value& map,
                          const char* key) {
      return ReadInterval(pair, least, *map.Find(key), where + "." + key, own);
    };
    count_ = read(params_.count, 0.0, value, "count");
    extent_ = read(params_.extent, 1e-3, value, "extent");
    if (params_.shell) {
      radius_ = read(params_.shell->radius, 0.0, *value.Find("shell"), "radius");
    }
    if (params_.approach) {
      approach_ = Approach(*params_.approach, *value.Find("approach"), where + ".approach", own);
    }
    if (params_.shell.has_value() == params_.approach.has_value()) {
      own.Add(value.location(), where + ": expected either shell or approach");
    }
    if (params_.shapes.empty()) {
      own.Add(value.location(), where + ".shapes: got none; expected one at least");
    }
    if (count_.lower != std::floor(count_.lower) || count_.upper != std::floor(count_.upper) ||
        count_.upper > 10000.0) {
      own.Add(value.location(), where + ".count: expected whole numbers up to 10000");
    }
  }
  problems.Add(own);
}

Value::List RandomObstacles::Draw(std::uint64_t seed, TaskGeometry& task,
                                  const Location& location) const {
  models::Random random(seed);
  const auto lower = static_cast<std::uint64_t>(count_.lower);
  const auto upper = static_cast<std::uint64_t>(count_.upper);
  const std::uint64_t count = lower + random.Below(upper - lower + 1);
  Value::List list;
  for (std::uint64_t i = 0; i < count; ++i) {
    models::Random own(models::Random::Seed(seed, i));
    const int number = static_cast<int>(i) + 1;
    if (params_.approach && approach_.jaws()) {
      for (Value& jaw : approach_.DrawJaws(own, number, extent_, task, location)) {
        list.push_back(std::move(jaw));
      }
    } else {
      list.push_back(DrawOne(own, number, task, location));
    }
  }
  return list;
}

Value RandomObstacles::DrawOne(models::Random& random, int number, TaskGeometry& task,
                               const Location& location) const {
  const Tree tree(location);
  const SampledShape shape = params_.shapes[random.Below(params_.shapes.size())];
  const std::string id =
      fmt::format("{}_{}", EnumNames(shape)[static_cast<std::size_t>(shape)], number);
  const Value solid = DrawShape(random, shape, location);
  const Value rotation = tree.List(DrawRotation(random));
  if (params_.approach) {
    const Coming coming = approach_.Draw(random, task, location);
    const Value pose = tree.Map({{"xyz", tree.List(coming.p_WO)}, {"quaternion", rotation}});
    if (coming.appear) {
      return tree.Map({{"id", tree.Text(id)},
                       {"shape", solid},
                       {"pose", pose},
                       {"motion", coming.motion},
                       {"appear", tree.Number(*coming.appear)}});
    }
    return tree.Map(
        {{"id", tree.Text(id)}, {"shape", solid}, {"pose", pose}, {"motion", coming.motion}});
  }
  const auto cube = [](double x) { return x * x * x; };
  const double radius = std::cbrt(random.Uniform(cube(radius_.lower), cube(radius_.upper)));
  const Vector3d p_WO = params_.shell->centre + radius * DrawDirection(random);
  const Value pose = tree.Map({{"xyz", tree.List(p_WO)}, {"quaternion", rotation}});
  return tree.Map({{"id", tree.Text(id)}, {"shape", solid}, {"pose", pose}});
}

Value RandomObstacles::DrawShape(models::Random& random, SampledShape shape,
                                 const Location& location) const {
  const Tree tree(location);
  const double a = extent_.Draw(random);
  const double b = extent_.Draw(random);
  const double c = extent_.Draw(random);
  const Value type = tree.Text(EnumNames(shape)[static_cast<std::size_t>(shape)]);
  switch (shape) {
    case SampledShape::kSphere:
      return tree.Map({{"type", type}, {"radius", tree.Number(a / 2)}});
    case SampledShape::kBox:
      return tree.Map({{"type", type}, {"size", tree.List(Vector3d(a, b, c))}});
    case SampledShape::kCylinder:
      return tree.Map({{"type", type}, {"radius", tree.Number(a / 2)}, {"length", tree.Number(b)}});
    case SampledShape::kCapsule:
      break;
  }
  constexpr double kShortest = 1e-3;  // of the straight part, m
  return tree.Map({{"type", type},
                   {"radius", tree.Number(std::min(a, b) / 2)},
                   {"length", tree.Number(std::max(std::abs(a - b), kShortest))}});
}

}  // namespace oca::sampling
