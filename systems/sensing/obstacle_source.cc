// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/sensing/near_obstacles.h"
#include "oca/systems/signals/roles.h"
#include "oca/systems/signals/signal_limits.h"

namespace oca::systems {
namespace {

constexpr const char* kWorld = "world";

using FramePoses = std::map<std::string, Eigen::Isometry3d>;

const Eigen::Isometry3d& FindFrame(const FramePoses& frames, const std::string& name,
                                   const std::string& where) {
  const auto found = frames.find(name.empty() ? kWorld : name);
  if (found != frames.end()) return found->second;
  throw ConfigError(
      fmt::format("{}: got '{}'; expected world or a frame listed before", where, name));
}

FramePoses MakeFrames(const std::vector<ObstacleSource::Frame>& frames) {
  FramePoses poses{{kWorld, Eigen::Isometry3d::Identity()}};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string where = fmt::format("frames[{}]", i);
    const Eigen::Isometry3d X_WP = FindFrame(poses, frames[i].parent, where + ".parent");
    if (frames[i].name.empty() ||
        !poses.emplace(frames[i].name, X_WP * frames[i].pose.Pose(where + ".pose")).second) {
      throw ConfigError(fmt::format("{}.name: got '{}'; expected a name that is not taken", where,
                                    frames[i].name));
    }
  }
  return poses;
}

bool HasOwnPositions(const std::optional<MotionParams>& motion) {
  return motion && (motion->type == MotionType::kWaypoints || motion->type == MotionType::kCsv);
}

// Numbers that no other source of this process has.
std::uint64_t NewLayouts(std::size_t count) {
  static std::atomic<std::uint64_t> next{1};
  return next.fetch_add(count);
}

void Place(Obstacle& obstacle, const Eigen::Isometry3d& X_WF, const motion::BodyState& state) {
  obstacle.X_WO = X_WF * state.X_FO;
  obstacle.linear = X_WF.linear() * state.linear;
  obstacle.angular = X_WF.linear() * state.angular;
}

// The body, and how fast any of its points ever gets.
std::shared_ptr<const ObstacleBody> WithSpeed(const ObstacleBody& body,
                                              const motion::ScriptedMotion& script) {
  const auto fast = std::make_shared<ObstacleBody>(body);
  fast->fastest = script.fastest;
  if (script.turning > 0.0) {  // what has no end does not turn
    fast->fastest +=
        script.turning * (body.collider->centre().norm() + body.collider->bounding_radius());
  }
  return fast;
}

PortSpec OffsetsSpec(const ObstacleSource::Params& params) {
  const auto size = static_cast<Eigen::Index>(3 * params.obstacles.size());
  Plausible plausible{Eigen::VectorXd::Constant(size, -kFarthest),
                      Eigen::VectorXd::Constant(size, kFarthest),
                      {},
                      "m from where the file has it"};
  for (const ObstacleSource::ObstacleParams& obstacle : params.obstacles) {
    for (const char* const axis : {"x", "y", "z"}) {
      plausible.names.push_back(fmt::format("obstacle '{}' {}", obstacle.id, axis));
    }
  }
  return {static_cast<int>(size), "m", std::make_shared<const Plausible>(std::move(plausible))};
}

Eigen::Isometry3d StartPose(const ObstacleSource::ObstacleParams& params,
                            const std::string& where) {
  const bool positions_elsewhere = HasOwnPositions(params.motion);
  if (!params.pose && !positions_elsewhere) {
    throw ConfigError(where + ": got none; expected one, {xyz, rpy}");
  }
  const PoseParams pose = params.pose.value_or(PoseParams{});
  if (positions_elsewhere && !pose.xyz.isZero(0.0)) {
    throw ConfigError(where + ".xyz: got a position; expected none, the waypoints give it");
  }
  return pose.Pose(where);
}

/// What has its place in the world and stays there.
std::vector<HoldsObstacles::Standing> StandingOf(const ObstacleSource::Params& params) {
  std::vector<HoldsObstacles::Standing> standing;
  for (int i = 0; i < std::ssize(params.obstacles); ++i) {
    const ObstacleSource::ObstacleParams& obstacle = params.obstacles[static_cast<std::size_t>(i)];
    if (obstacle.motion || !obstacle.frame.empty() || !obstacle.pose) continue;
    const Eigen::Vector3d& xyz = obstacle.pose->xyz;
    standing.push_back(
        {obstacle.id, fmt::format("obstacles.{}.pose.xyz", i), {xyz.x(), xyz.y(), xyz.z()}, 3 * i});
  }
  return standing;
}

}  // namespace

void ObstacleSource::Frame::Describe(Fields<Frame>& fields) {
  fields.Add("name", &Frame::name, "", "what obstacles and later frames call it").Required();
  fields.Add("pose", &Frame::pose, "", "in the parent frame").Required();
  fields.Add("parent", &Frame::parent, "", "a frame listed before; the world if left out");
}

void ObstacleSource::ObstacleParams::Describe(Fields<ObstacleParams>& fields) {
  using P = ObstacleParams;
  fields.Add("id", &P::id, "", "unique name").Required();
  fields.Add("shape", &P::shape, "", "about its own origin").Required();
  fields.Add("pose", &P::pose, "", "where it starts; with waypoints only its rotation counts");
  fields.Add("frame", &P::frame, "", "frame of pose and motion; the world if left out");
  fields.Add("motion", &P::motion, "", "how it moves; it stands if left out");
  fields.Add("appear", &P::appear, "s", "from when it is there; always if left out");
  fields.Add("disappear", &P::disappear, "s", "from when it is gone; never if left out");
}

void ObstacleSource::Params::Describe(Fields<Params>& fields) {
  fields.Add("period", &Params::period, "s", "time between samples; 0: moves continuously")
      .AtLeast(0.0);
  fields.Add("frames", &Params::frames, "", "frames at rest that poses may be given in");
  fields.Add("obstacles", &Params::obstacles, "", "what is in the robot's way");
}

ObstacleSource::Params ObstacleSource::Example() {
  ObstacleParams box;
  box.id = "box";
  box.shape.type = ShapeType::kBox;
  box.shape.size = Eigen::Vector3d(0.2, 0.2, 0.2);
  box.pose = PoseParams{{0.0, 0.6, 1.0}, {}, {}};
  return {.period = Period(1, 100), .frames = {}, .obstacles = {box}};
}

ObstacleSource::ObstacleSource(const Params& params)
    : period_(params.period),
      entries_(MakeEntries(params)),
      moving_(MakeMoving()),
      changes_(MakeChanges()),
      layout_(NewLayouts(changes_.size() + 1)),
      offsets(DeclareOptionalInput<Vector>("offsets", OffsetsSpec(params))),
      obstacles(DeclareObstacles(params)) {
  DeclareRole(Boundary{"the camera"});
  DeclareRole(HoldsObstacles{.obstacles = obstacles,
                             .offsets = offsets,
                             .standing = StandingOf(params),
                             .unsampled = [params]() -> std::unique_ptr<System> {
                               Params always = params;
                               always.period = Period();
                               return std::make_unique<ObstacleSource>(always);
                             }});
  DeclareRole(Remarks{.warnings = warnings_});
}

std::vector<ObstacleSource::Entry> ObstacleSource::MakeEntries(const Params& params) {
  Validated(params);
  const FramePoses frames = MakeFrames(params.frames);
  std::set<std::string> ids;
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < params.obstacles.size(); ++i) {
    const ObstacleParams& obstacle = params.obstacles[i];
    if (obstacle.id.empty() || !ids.insert(obstacle.id).second) {
      throw ConfigError(fmt::format("obstacles[{}].id: got '{}'; expected an id that is not taken",
                                    i, obstacle.id));
    }
    const std::string where = fmt::format("obstacles[{}] '{}'", i, obstacle.id);
    entries.push_back(MakeEntry(obstacle, FindFrame(frames, obstacle.frame, where + ".frame")));
  }
  CheckStarts(entries);
  return entries;
}

/// What files may say of one obstacle is bounded, but frames and motions add up.
void ObstacleSource::CheckStarts(const std::vector<Entry>& entries) {
  ObstacleSet set;
  for (const Entry& entry : entries) {
    Obstacle& obstacle = set.obstacles.emplace_back();
    obstacle.body = entry.body;
    Place(obstacle, entry.X_WF, entry.motion(std::max(entry.appear, 0.0)));
  }
  if (const Fault fault = Signal<ObstacleSet>::Check(set, Look::kWhole); !fault.ok()) {
    throw ConfigError(fault.text());
  }
}

ObstacleSource::Entry ObstacleSource::MakeEntry(const ObstacleParams& params,
                                                const Eigen::Isometry3d& X_WF) {
  const std::string where = fmt::format("obstacle '{}'", params.id);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Entry entry{MakeObstacleBody(params.id, params.shape, where + ".shape", &warnings_),
              nullptr,
              X_WF,
              {},
              params.appear.value_or(-kInfinity),
              params.disappear.value_or(kInfinity),
              !params.motion || params.motion->type == MotionType::kStatic};
  entry.motion = MakeMotion(params.motion.value_or(MotionParams{}),
                            StartPose(params, where + ".pose"), where + ".motion");
  entry.body = WithSpeed(*entry.body, entry.motion);
  const auto free = std::make_shared<ObstacleBody>(*entry.body);
  free->fastest = kAnySpeed;
  entry.free_body = free;
  if (!(entry.appear < entry.disappear)) {
    throw ConfigError(fmt::format("{}.disappear: got {} s; expected more than appear, {} s", where,
                                  entry.disappear, entry.appear));
  }
  return entry;
}

Output<ObstacleSet> ObstacleSource::DeclareObstacles(const Params& params) {
  const bool stands =
      std::all_of(params.obstacles.begin(), params.obstacles.end(), [](const ObstacleParams& o) {
        return (!o.motion || o.motion->type == MotionType::kStatic) && !o.appear && !o.disappear;
      });
  // What does not depend on the time is computed once.
  if (stands)
    return DeclareOutput<ObstacleSet, &ObstacleSource::CalcStanding>("obstacles", {}, offsets);
  return DeclareOutput<ObstacleSet, &ObstacleSource::CalcObstacles>("obstacles", {}, kTime,
                                                                    offsets);
}

double ObstacleSource::SampleTime(double time) const {
  if (!period_.positive()) return time;
  const auto numerator = static_cast<double>(period_.numerator());
  const auto denominator = static_cast<double>(period_.denominator());
  const double ticks = time * denominator / numerator;
  const double nearest = std::round(ticks);
  // A tick's time is the rational rounded to a double, so `ticks` may miss the integer by a little.
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  const bool on_tick = std::fabs(ticks - nearest) <= kRounding * std::fabs(nearest);
  return (on_tick ? nearest : std::floor(ticks)) * numerator / denominator;
}

std::vector<int> ObstacleSource::MakeMoving() const {
  std::vector<int> moving;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!entries_[i].stands) moving.push_back(static_cast<int>(i));
  }
  return moving;
}

std::vector<double> ObstacleSource::MakeChanges() const {
  std::vector<double> changes;
  for (const Entry& entry : entries_) {
    for (const double time : {entry.appear, entry.disappear}) {
      if (std::isfinite(time)) changes.push_back(time);
    }
  }
  std::sort(changes.begin(), changes.end());
  return changes;
}

void ObstacleSource::CalcObstacles(double time, std::optional<VectorView> shifts,
                                   ObstacleSet& set) const {
  const double sample_time = SampleTime(time);
  if (shifts) {
    FillIn(sample_time, &*shifts, set);
    set.layout = 0;
    return;
  }
  const auto past = std::upper_bound(changes_.begin(), changes_.end(), sample_time);
  const std::uint64_t layout = layout_ + static_cast<std::uint64_t>(past - changes_.begin());
  if (set.layout != layout) {
    FillIn(sample_time, nullptr, set);
    set.layout = layout;
    return;
  }
  auto place = set.moving.begin();
  for (const int i : moving_) {
    const Entry& entry = entries_[static_cast<std::size_t>(i)];
    if (!entry.There(sample_time)) continue;
    Place(set.obstacles[static_cast<std::size_t>(*place++)], entry.X_WF, entry.motion(sample_time));
  }
}

void ObstacleSource::FillIn(double sample_time, const VectorView* shifts, ObstacleSet& set) const {
  set.obstacles.reserve(entries_.size());  // so that no obstacle that appears allocates
  set.moving.reserve(entries_.size());
  set.moving.clear();
  std::size_t count = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    if (!entry.There(sample_time)) continue;
    if (!entry.stands || shifts != nullptr) set.moving.push_back(static_cast<int>(count));
    if (count == set.obstacles.size()) set.obstacles.emplace_back();
    Obstacle& obstacle = set.obstacles[count++];
    const auto& body = shifts == nullptr ? entry.body : entry.free_body;
    if (obstacle.body != body) obstacle.body = body;
    Place(obstacle, entry.X_WF, entry.motion(sample_time));
    if (shifts == nullptr) continue;
    obstacle.X_WO.translation() += shifts->segment<3>(static_cast<Eigen::Index>(3 * i));
  }
  set.obstacles.resize(count);
}

void ObstacleSource::CalcStanding(std::optional<VectorView> shifts, ObstacleSet& set) const {
  CalcObstacles(0.0, shifts, set);
}

}  // namespace oca::systems
