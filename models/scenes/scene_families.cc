// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/scene_families.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/nearest_name.h"

namespace oca::scenes {
namespace {

using Eigen::Vector3d;
using models::Random;

constexpr double kBoard = 0.04;  // thickness, m at scale 1, as all lengths here
constexpr double kCanRadius = 0.03;
constexpr double kCanHeight = 0.14;

/// Puts furniture into a frame of its own: x away from the arm, y to the left, z up from the arm's
/// foot; its lengths are those at scale 1.
class Furnisher {
 public:
  Furnisher(double scale, Random& random) : scale_(scale), random_(random) {}

  FurnishedScene Take() { return std::move(scene_); }
  double Draw(double lower, double upper) { return random_.Uniform(lower, upper); }
  std::size_t Pick(std::size_t count) { return random_.Below(count); }

  /// The frame: `distance` away from the arm in any direction, a little turned.
  void Place(double distance) {
    const double direction = Draw(-0.8 * std::numbers::pi, 0.8 * std::numbers::pi);
    const double turn = direction + Draw(-0.3, 0.3);
    scene_.X_WF.translation() =
        scale_ * distance * Vector3d(std::cos(direction), std::sin(direction), 0.0);
    scene_.X_WF.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix();
  }

  void Box(const std::string& id, const Vector3d& size, const Vector3d& p_FB, double yaw = 0.0,
           double pitch = 0.0) {
    Eigen::Isometry3d X_FB = Eigen::Isometry3d::Identity();
    X_FB.linear() =
        (Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY()))
            .toRotationMatrix();
    X_FB.translation() = scale_ * p_FB;
    Add(id, geometry::Box{scale_ * size}, X_FB);
  }

  /// Standing on `p_FB`.
  void Can(const std::string& id, double radius, double height, const Vector3d& p_FB) {
    Eigen::Isometry3d X_FB = Eigen::Isometry3d::Identity();
    X_FB.translation() = scale_ * (p_FB + Vector3d(0.0, 0.0, 0.5 * height + 0.005));
    Add(id, geometry::Cylinder{scale_ * radius, scale_ * height}, X_FB);
  }

  /// Its axis goes up; `approach` is that of a hand, in the frame of the furniture.
  void Aim(const std::string& id, double radius, double height, const Vector3d& approach_F) {
    for (const SceneObject& object : scene_.objects) {
      if (object.id == id) scene_.target = object.X_FO.translation();
    }
    scene_.target_radius = scale_ * radius;
    scene_.target_height = scale_ * height;
    scene_.approach = scene_.X_WF.linear() * approach_F;
  }

  void Table(double height, bool below) {
    scene_.table = scale_ * height;
    scene_.starts_below = below;
  }

 private:
  void Add(const std::string& id, const geometry::Shape& shape, const Eigen::Isometry3d& X_FB) {
    SceneObject object{.id = id, .X_FO = scene_.X_WF * X_FB};
    object.bodies.push_back({shape});
    scene_.objects.push_back(std::move(object));
  }

  const double scale_;
  Random& random_;
  FurnishedScene scene_;
};

/// Cans on boards at these heights, so many on each, near the front; one of them is aimed at.
void AddCans(Furnisher& f, const std::vector<double>& tops, int each, double front, double deepest,
             double half_width) {
  int number = 0;
  for (const double top : tops) {
    for (int i = 0; i < each; ++i) {
      // Each has a part of the width to itself, so that none stands in another.
      const double width = 2.0 * half_width / each;
      const double y = -half_width + width * (i + 0.5) + f.Draw(-0.3, 0.3) * width;
      f.Can(fmt::format("can_{}", ++number), kCanRadius, kCanHeight,
            {front + f.Draw(0.06, deepest), y, top});
    }
  }
  f.Aim(fmt::format("can_{}", 1 + f.Pick(static_cast<std::size_t>(number))), kCanRadius, kCanHeight,
        Vector3d::UnitX());
}

/// Boards with sides, open to the front.
void BookshelfSmall(Furnisher& f) {
  f.Place(f.Draw(1.05, 1.2));
  const double z = f.Draw(0.2, 0.5), depth = 1.2, half = 0.5;
  f.Box("shelf_bottom", {depth, 2.0 * half, kBoard}, {0.0, 0.0, z});
  f.Box("shelf_top", {depth, 2.0 * half, kBoard}, {0.0, 0.0, z + 0.3});
  f.Box("side_left", {depth, kBoard, 0.34}, {0.0, half, z + 0.15});
  f.Box("side_right", {depth, kBoard, 0.34}, {0.0, -half, z + 0.15});
  AddCans(f, {z + 0.5 * kBoard}, 3, -0.5 * depth, 0.25, 0.4);
}

void BookshelfTall(Furnisher& f) {
  f.Place(f.Draw(1.05, 1.2));
  const double depth = 1.2, half = 0.5;
  const char* const names[] = {"bottom", "middle_bottom", "middle_top", "top"};
  for (int i = 0; i < 4; ++i) {
    f.Box(fmt::format("shelf_{}", names[i]), {depth, 2.0 * half, kBoard}, {0.0, 0.0, 0.3 * i});
  }
  f.Box("side_left", {depth + 0.1, kBoard, 1.6}, {0.0, half, 0.12});
  f.Box("side_right", {depth + 0.1, kBoard, 1.6}, {0.0, -half, 0.12});
  AddCans(f, {0.02, 0.32, 0.62}, 3, -0.5 * depth, 0.25, 0.4);
}

/// Narrow boards on four posts, with a board upright in the middle.
void BookshelfThin(Furnisher& f) {
  f.Place(f.Draw(0.8, 0.95));
  const double depth = 0.6, half = 0.5;
  std::vector<double> tops;
  for (int i = 0; i < 6; ++i) {
    const double z = -0.35 + 0.25 * i;
    f.Box(fmt::format("shelf_{}", i + 1), {depth, 2.0 * half, kBoard}, {0.0, 0.0, z});
    if (i < 5) tops.push_back(z + 0.5 * kBoard);
  }
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-1.0, 1.0}) {
      f.Box(fmt::format("leg_{}{}", x < 0.0 ? 'f' : 'b', y < 0.0 ? 'r' : 'l'),
            {kBoard, kBoard, 1.6}, {x * depth, y * half, 0.12});
    }
  }
  f.Box("shelf_upright", {depth, kBoard, 1.25}, {0.0, 0.0, 0.275});
  AddCans(f, tops, 2, -0.5 * depth, 0.2, 0.42);
}

/// A box whose lid is half open, below the arm's foot.
void OpenBox(Furnisher& f) {
  f.Place(f.Draw(0.5, 0.65));
  const double z = f.Draw(-0.52, -0.46), half = 0.35;
  f.Box("base", {0.7, 0.7, kBoard}, {0.0, 0.0, z});
  f.Box("side_back", {kBoard, 0.7, 0.7}, {half, 0.0, z + 0.35});
  f.Box("side_front", {kBoard, 0.7, 0.6}, {-half, 0.0, z + 0.3});
  f.Box("side_left", {0.7, kBoard, 0.7}, {0.0, half, z + 0.35});
  f.Box("side_right", {0.7, kBoard, 0.7}, {0.0, -half, z + 0.35});
  f.Box("side_cap", {0.7, 0.7, kBoard}, {0.15, 0.0, z + 0.9}, 0.0, 0.8);
  f.Can("can_1", kCanRadius, kCanHeight,
        {f.Draw(-0.2, 0.1), f.Draw(-0.22, 0.22), z + 0.5 * kBoard});
  f.Aim("can_1", kCanRadius, kCanHeight,
        Vector3d(f.Draw(-0.2, 0.5), f.Draw(-0.3, 0.3), -1.0).normalized());
}

/// A box with two bars in front, between which a hand goes.
void Cage(Furnisher& f) {
  f.Place(f.Draw(0.75, 0.85));
  const double z = f.Draw(0.15, 0.25), half = 0.35;
  f.Box("base", {0.7, 0.7, kBoard}, {0.0, 0.0, z});
  f.Box("side_back", {kBoard, 0.7, 0.7}, {half, 0.0, z + 0.35});
  f.Box("side_cap", {0.65, 0.65, kBoard}, {0.04, 0.0, z + 0.7});
  f.Box("side_front_a", {kBoard, 0.7, kBoard}, {-half, 0.0, z + 0.15});
  f.Box("side_front_b", {kBoard, 0.7, kBoard}, {-half, 0.0, z + 0.45});
  f.Box("side_left", {0.7, kBoard, 0.7}, {0.0, half, z + 0.35});
  f.Box("side_right", {0.7, kBoard, 0.7}, {0.0, -half, z + 0.35});
  const double cube = 0.07;
  f.Box("cube_1", {cube, cube, cube},
        {f.Draw(-0.15, 0.12), f.Draw(-0.15, 0.15), z + 0.5 * (kBoard + cube) + 0.005});
  // A little from above, over the lower bar.
  f.Aim("cube_1", 0.5 * cube, cube, Vector3d(1.0, 0.0, f.Draw(-0.9, -0.4)).normalized());
}

/// A table with things on it; a can among them is aimed at from above.
void TableWith(Furnisher& f, bool starts_below) {
  f.Place(f.Draw(0.9, 1.05));
  const double z = f.Draw(0.2, 0.3), top = z + 0.5 * kBoard;
  f.Box("table_top", {1.2, 2.0, kBoard}, {0.0, 0.0, z});
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-1.0, 1.0}) {
      f.Box(fmt::format("table_leg_{}_{}", y < 0.0 ? "right" : "left", x < 0.0 ? "front" : "back"),
            {0.05, 0.05, 0.7}, {0.95 * x, 0.85 * y, z - 0.35 - 0.5 * kBoard});
    }
  }
  // Each stands near a place of its own.
  const auto at = [&](double x, double y, double half_height) {
    return Vector3d(x + f.Draw(-0.05, 0.05), y + f.Draw(-0.06, 0.06), top + half_height + 0.005);
  };
  const auto turn = [&] { return f.Draw(-std::numbers::pi, std::numbers::pi); };
  f.Box("cube", {0.25, 0.25, 0.25}, at(-0.15, 0.45, 0.125), turn());
  f.Can("object_1", 0.05, 0.35, at(0.3, -0.05, -0.005));
  f.Box("object_2", {0.2, 0.02, 0.4}, at(0.05, -0.25, 0.2), turn());
  f.Box("object_3", {0.02, 0.2, 0.4}, at(-0.25, 0.2, 0.2), turn());
  f.Box("object_4", {0.2, 0.05, 0.35}, at(-0.4, -0.35, 0.175), turn());
  f.Box("object_5", {0.2, 0.05, 0.35}, at(0.2, 0.2, 0.175), turn());
  f.Can("can_1", kCanRadius, 0.12, at(-0.35, -0.05, -0.005));
  f.Aim("can_1", kCanRadius, 0.12, -Vector3d::UnitZ());
  f.Table(z, starts_below);
}

}  // namespace

FurnishedScene Furnish(std::string_view family, double scale, Random& random) {
  Furnisher f(scale, random);
  if (family == "bookshelf_small") {
    BookshelfSmall(f);
  } else if (family == "bookshelf_tall") {
    BookshelfTall(f);
  } else if (family == "bookshelf_thin") {
    BookshelfThin(f);
  } else if (family == "box") {
    OpenBox(f);
  } else if (family == "cage") {
    Cage(f);
  } else if (family == "table_pick" || family == "table_under_pick") {
    TableWith(f, family == "table_under_pick");
  } else {
    const std::vector<std::string> known(kSceneFamilies.begin(), kSceneFamilies.end());
    throw models::ModelError(
        fmt::format("family; got '{}'; expected one of scenes, nearest is '{}'", family,
                    models::NearestName(family, known)));
  }
  return f.Take();
}

}  // namespace oca::scenes
