// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sampling/approach.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace oca::sampling {
namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.80665;  // m/s^2
constexpr double kBeyond = 0.1;       // s; for which something gets faster beyond its aim
constexpr double kPeak = 1.875;       // largest speed of a smooth reach, of its mean
constexpr double kThickness = 0.04;   // m; of a jaw

// A point on the polyline through the origins of the moving links from one of them on.
Vector3d DrawPointOfArm(models::Random& random, const TaskGeometry& task, const Eigen::VectorXd& q,
                        const std::string& from_link) {
  const auto& bodies = task.model().bodies();
  const auto X_WL = task.LinkPosesAt(q);
  const int first =
      from_link.empty() ? bodies[bodies.size() > 2 ? 1 : 0] : task.model().FindLink(from_link);
  std::vector<Vector3d> origins{X_WL[static_cast<std::size_t>(first)].translation()};
  for (const int body : bodies) {
    if (body > first) origins.push_back(X_WL[static_cast<std::size_t>(body)].translation());
  }
  double total = 0.0;
  for (std::size_t i = 0; i + 1 < origins.size(); ++i) {
    total += (origins[i + 1] - origins[i]).norm();
  }
  double left = random.Unit() * total;
  for (std::size_t i = 0; i + 1 < origins.size(); ++i) {
    const Vector3d piece = origins[i + 1] - origins[i];
    if (left < piece.norm()) return origins[i] + left * piece.normalized();
    left -= piece.norm();
  }
  return origins.back();
}

Vector3d DrawSideways(models::Random& random, const Vector3d& direction) {
  const Vector3d any = DrawDirection(random);
  return direction.cross(any + 1e-9 * direction.unitOrthogonal()).normalized();
}

Eigen::Vector4d Coefficients(const Eigen::Matrix3d& R) { return Eigen::Quaterniond(R).coeffs(); }

}  // namespace

Vector3d DrawDirection(models::Random& random) {
  const double z = random.Uniform(-1.0, 1.0);
  const double azimuth = random.Uniform(-std::numbers::pi, std::numbers::pi);
  const double r = std::sqrt(1.0 - z * z);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

Value Tree::List(const Eigen::Ref<const Eigen::VectorXd>& numbers) const {
  Value::List list;
  for (const double x : numbers) list.push_back(Number(x));
  return Value(std::move(list), location_);
}

Value Tree::Map(std::initializer_list<std::pair<const char*, Value>> entries) const {
  Value::Map map;
  for (const auto& [key, value] : entries) map.push_back({key, location_, value});
  return Value(std::move(map), location_);
}

void ApproachParams::Describe(Fields<ApproachParams>& fields) {
  using P = ApproachParams;
  fields.Add("manner", &P::manner, "",
             "straight, turning, circling, accelerating, oscillating, stopping, feint, hand, "
             "falling, jaws or behind");
  fields.Add("speed", &P::speed, "m/s", "least and largest").Required();
  fields.Add("distance", &P::distance, "m", "from its aim at the start, least and largest")
      .Required();
  fields.Add("start", &P::start, "s", "when it starts to move, earliest and latest").Required();
  fields.Add("from_link", &P::from_link, "",
             "first link that is aimed at; the second one that moves if left out: the first cannot "
             "evade");
  fields.Add("bend", &P::bend, "rad/s", "turning: how fast its way turns, least and largest");
  fields.Add("acceleration", &P::acceleration, "m/s^2", "accelerating: least and largest");
  fields.Add("sight", &P::sight, "s", "behind: before it is at its aim, least and largest");
}

Approach::Approach(const ApproachParams& params, const Value& value, const std::string& where,
                   Problems& problems)
    : params_(params) {
  const auto read = [&](const Eigen::VectorXd& pair, double least, const char* key) {
    return ReadInterval(pair, least, *value.Find(key), fmt::format("{}.{}", where, key), problems);
  };
  speed_ = read(params.speed, params.manner == Manner::kAccelerating ? 0.0 : 1e-3, "speed");
  const bool straight = params.manner == Manner::kStraight;
  distance_ = read(params.distance, straight ? 0.0 : 1e-3, "distance");
  start_ = read(params.start, 0.0, "start");
  const auto own = [&](const std::optional<Eigen::VectorXd>& pair, Manner manner, double least,
                       const char* key, Interval& interval) {
    const char* const name = EnumNames(manner)[static_cast<std::size_t>(manner)];
    if (pair.has_value() != (params.manner == manner)) {
      problems.Add(value.location(), fmt::format("{}.{}: got {}; expected one with manner {} alone",
                                                 where, key, pair ? "one" : "none", name));
    } else if (pair) {
      interval = read(*pair, least, key);
    }
  };
  own(params.bend, Manner::kTurning, 1e-3, "bend", bend_);
  own(params.acceleration, Manner::kAccelerating, 1e-3, "acceleration", acceleration_);
  own(params.sight, Manner::kBehind, 0.0, "sight", sight_);
}

/// What every manner has.
struct Approach::Course {
  double speed;
  double distance;
  double start;
  double acceleration{0.0};
  double span{0.0};  ///< s; from the start to the aim
  Vector3d aim{Vector3d::Zero()};
  Vector3d from{Vector3d::Zero()};  ///< a direction

  double arrival() const { return start + span; }
};

/// Time to the aim.
double Approach::SpanOf(const Course& course) const {
  switch (params_.manner) {
    case Manner::kAccelerating:
    case Manner::kFalling: {
      const double v = params_.manner == Manner::kFalling ? 0.0 : course.speed;
      const double a = course.acceleration;
      return (std::sqrt(v * v + 2.0 * a * course.distance) - v) / a;
    }
    case Manner::kHand:
      return kPeak * course.distance / course.speed;
    default:
      return course.distance / course.speed;
  }
}

Approach::Course Approach::DrawCourse(models::Random& random, TaskGeometry& task) const {
  Course course{speed_.Draw(random), distance_.Draw(random), start_.Draw(random)};
  if (params_.manner == Manner::kAccelerating) course.acceleration = acceleration_.Draw(random);
  if (params_.manner == Manner::kFalling) course.acceleration = kGravity;
  course.span = SpanOf(course);
  const Eigen::VectorXd q = task.Request(course.arrival());
  course.aim = DrawPointOfArm(random, task, q, params_.from_link);
  course.from = DrawDirection(random);
  if (params_.manner == Manner::kFalling) course.from = Vector3d::UnitZ();
  return course;
}

Coming Approach::Draw(models::Random& random, TaskGeometry& task, const Location& location) const {
  const Course course = DrawCourse(random, task);
  Coming coming;
  coming.p_WO = course.aim + course.distance * course.from;
  coming.motion = MotionOf(course, random, Tree(location), coming);
  return coming;
}

Value Approach::MotionOf(const Course& course, models::Random& random, const Tree& tree,
                         Coming& coming) const {
  const Vector3d velocity = -course.speed * course.from;
  const Value start = tree.Number(course.start);
  switch (params_.manner) {
    case Manner::kTurning:
      return Turning(course, random, tree, coming);
    case Manner::kCircling:
      return Circling(course, random, tree, coming);
    case Manner::kAccelerating:
    case Manner::kFalling: {
      const bool falls = params_.manner == Manner::kFalling;
      return tree.Map({{"type", tree.Text("accelerating")},
                       {"velocity", tree.List(falls ? Vector3d(Vector3d::Zero()) : velocity)},
                       {"acceleration", tree.List(-course.acceleration * course.from)},
                       {"start", start},
                       {"stop", tree.Number(course.arrival() + kBeyond)}});
    }
    case Manner::kOscillating:
      return Oscillating(course, tree, coming);
    case Manner::kFeint:
      coming.p_WO.setZero();  // the waypoints say where it is
      return Feint(course, random, tree);
    case Manner::kHand:
      coming.p_WO.setZero();
      return Reaches(course, tree);
    default:
      break;
  }
  if (params_.manner == Manner::kBehind) coming.appear = course.arrival() - sight_.Draw(random);
  Value motion = tree.Map(
      {{"type", tree.Text("linear")}, {"velocity", tree.List(velocity)}, {"start", start}});
  if (params_.manner != Manner::kStopping) return motion;
  return tree.Map({{"type", tree.Text("linear")},
                   {"velocity", tree.List(velocity)},
                   {"start", start},
                   {"stop", tree.Number(course.arrival())}});
}

Value Approach::Turning(const Course& course, models::Random& random, const Tree& tree,
                        Coming& coming) const {
  const Vector3d velocity = -course.speed * course.from;
  const double bend = bend_.Draw(random);
  const Vector3d w = bend * DrawSideways(random, course.from);
  // From the aim backwards: the way there is the way back with the turn reversed.
  const Eigen::AngleAxisd back(-bend * course.span, w.normalized());
  const double angle = bend * course.span;
  const Vector3d way = std::sin(angle) / bend * velocity -
                       (1.0 - std::cos(angle)) / (bend * bend) * w.cross(velocity);
  coming.p_WO = course.aim - way;
  return tree.Map({{"type", tree.Text("turning")},
                   {"velocity", tree.List(back * velocity)},
                   {"angular_velocity", tree.List(w)},
                   {"start", tree.Number(course.start)}});
}

Value Approach::Circling(const Course& course, models::Random& random, const Tree& tree,
                         Coming& coming) const {
  const Vector3d axis = DrawSideways(random, course.from);
  const double rate = course.speed / course.distance;
  const Vector3d centre = course.aim + course.distance * course.from;
  coming.p_WO = centre + Eigen::AngleAxisd(-rate * course.arrival(), axis) * (course.aim - centre);
  return tree.Map({{"type", tree.Text("circular")},
                   {"center", tree.List(centre)},
                   {"axis", tree.List(axis)},
                   {"angular_velocity", tree.Number(rate)}});
}

Value Approach::Oscillating(const Course& course, const Tree& tree, Coming& coming) const {
  const double frequency = course.speed / (2.0 * std::numbers::pi * course.distance);
  const double phase =
      std::remainder(std::numbers::pi - 2.0 * std::numbers::pi * frequency * course.arrival(),
                     2.0 * std::numbers::pi);
  coming.p_WO = course.aim;
  return tree.Map({{"type", tree.Text("sinusoidal")},
                   {"amplitude", tree.List(course.distance * course.from)},
                   {"frequency", tree.Number(frequency)},
                   {"phase", tree.Number(phase)}});
}

/// To the aim and back, a pause, and once more.
Value Approach::Reaches(const Course& course, const Tree& tree) const {
  const Vector3d away = course.aim + course.distance * course.from;
  constexpr double kPause = 0.5;  // s
  Value::List points;
  double time = course.start;
  for (int reach = 0; reach < 2; ++reach) {
    for (const Vector3d& p : {away, course.aim, away}) {
      points.push_back(tree.Map({{"time", tree.Number(time)}, {"xyz", tree.List(p)}}));
      time += course.span;
    }
    time += kPause - course.span;
  }
  return tree.Map({{"type", tree.Text("waypoints")},
                   {"waypoints", tree.List(std::move(points))},
                   {"smooth", tree.Flag(true)}});
}

/// Towards the aim, aside and back before it is there, and then through it.
Value Approach::Feint(const Course& course, models::Random& random, const Tree& tree) const {
  const double left = random.Uniform(0.3, 0.5) * course.distance;  // m; where it turns back
  const Vector3d aside = DrawSideways(random, course.from);
  const Vector3d near = course.aim + left * course.from;
  const Vector3d back = near + 0.3 * course.distance * (course.from + aside);
  const Vector3d beyond = course.aim + 20.0 * (course.aim - back);
  Value::List points;
  double time = course.start;
  Vector3d before = course.aim + course.distance * course.from;
  for (const Vector3d& p : {before, near, back, beyond}) {
    time += (p - before).norm() / course.speed;
    points.push_back(tree.Map({{"time", tree.Number(time)}, {"xyz", tree.List(p)}}));
    before = p;
  }
  return tree.Map({{"type", tree.Text("waypoints")}, {"waypoints", tree.List(std::move(points))}});
}

Value::List Approach::DrawJaws(models::Random& random, int number, const Interval& extent,
                               TaskGeometry& task, const Location& location) const {
  const Tree tree(location);
  const Course course = DrawCourse(random, task);
  const Vector3d other = DrawSideways(random, course.from);
  const double face = extent.Draw(random);
  const double way = course.distance - 0.5 * kThickness;
  Value::List jaws;
  int k = 0;
  for (const Vector3d& from : {course.from, Vector3d(-course.from), other, Vector3d(-other)}) {
    Eigen::Matrix3d R;
    R << from, course.from.cross(other).cross(from), course.from.cross(other);
    const Vector3d p_WO = course.aim + course.distance * from;
    const Value motion = tree.Map({{"type", tree.Text("linear")},
                                   {"velocity", tree.List(-course.speed * from)},
                                   {"start", tree.Number(course.start)},
                                   {"stop", tree.Number(course.start + way / course.speed)}});
    jaws.push_back(tree.Map(
        {{"id", tree.Text(fmt::format("jaw_{}_{}", number, ++k))},
         {"shape", tree.Map({{"type", tree.Text("box")},
                             {"size", tree.List(Vector3d(kThickness, face, face))}})},
         {"pose", tree.Map({{"xyz", tree.List(p_WO)}, {"quaternion", tree.List(Coefficients(R))}})},
         {"motion", motion}}));
  }
  return jaws;
}

}  // namespace oca::sampling
