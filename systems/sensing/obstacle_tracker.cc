// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "oca/framework/dataflow/fixed_text.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

using sensing::PoseUse;

/// Its place in the memory, -1 if it is not there; `hint` is looked at first.
int FindBody(const TrackMemory& memory, models::Name id, std::size_t hint) {
  const auto bodies = memory.bodies();
  if (hint < bodies.size() && bodies[hint].body->id == id) return static_cast<int>(hint);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].body->id == id) return static_cast<int>(i);
  }
  return -1;
}

bool CameBefore(const ObstacleSet& set, std::size_t place) {
  const models::Name id = set.obstacles[place].body->id;
  return std::any_of(set.obstacles.begin(),
                     set.obstacles.begin() + static_cast<std::ptrdiff_t>(place),
                     [&](const Obstacle& other) { return other.body->id == id; });
}

TrackState StateAfter(PoseUse use, TrackState before) {
  if (use == PoseUse::kFirst) return TrackState::kNew;
  if (use == PoseUse::kRefused) return TrackState::kDoubted;
  if (before == TrackState::kLost) return TrackState::kBack;
  return use == PoseUse::kTurn ? TrackState::kTurning : TrackState::kTracked;
}

sensing::BodyFilterSettings SettingsOf(const ObstacleTracker::Params& params) {
  return {.position_noise = params.position_noise,
          .angle_noise = params.angle_noise,
          .acceleration_density = params.acceleration_density,
          .turning_density = params.turning_density,
          .erratic_density = params.erratic_density,
          .spin_density = params.spin_density,
          .switching = params.switching,
          .turning_end = params.turning_end,
          .prior_speed = params.prior_speed,
          .fastest = params.fastest};
}

/// Calls use(obstacle) for what there is no room for in the memory.
template <class Use>
void ForUntracked(const ObstacleSet& set, const TrackMemory& memory, const Use& use) {
  for (std::size_t i = 0; i < set.obstacles.size(); ++i) {
    const bool tracked = FindBody(memory, set.obstacles[i].body->id, i) >= 0;
    if (!tracked && !CameBefore(set, i)) use(set.obstacles[i]);
  }
}

}  // namespace

TrackMemory& TrackMemory::operator=(const TrackMemory& other) {
  room_.resize(other.room_.size());
  count_ = other.count_;
  std::copy_n(other.room_.begin(), count_, room_.begin());
  looked = other.looked;
  return *this;
}

void TrackMemory::Forget(double time, double longest) {
  const auto kept = std::remove_if(bodies().begin(), bodies().end(),
                                   [&](const Body& body) { return time - body.seen > longest; });
  count_ = static_cast<std::size_t>(kept - bodies().begin());
}

void ObstacleTracker::Params::Describe(Fields<Params>& fields) {
  using P = Params;
  AddControlPeriod(fields);
  fields.Add("latency", &P::latency, "s", "how much older the poses of a set are than its stamp")
      .AtLeast(0.0);
  fields.Add("keep_time", &P::keep_time, "s", "how long a body goes on that is no more seen")
      .AtLeast(0.0);
  fields.Add("most_bodies", &P::most_bodies, "", "for how many there is room")
      .AtLeast(1.0)
      .AtMost(1000.0);
  fields
      .Add("position_noise", &P::position_noise, "m",
           "standard deviation of positions along each axis")
      .Above(0.0);
  fields
      .Add("angle_noise", &P::angle_noise, "rad", "standard deviation of rotations about each axis")
      .Above(0.0);
  fields
      .Add("acceleration_density", &P::acceleration_density, "m^2/s^3",
           "spectral density of the acceleration of what goes straight")
      .Above(0.0);
  fields
      .Add("turning_density", &P::turning_density, "m^2/s^5",
           "spectral density of the jerk of what turns or gets faster")
      .Above(0.0);
  fields
      .Add("erratic_density", &P::erratic_density, "m^2/s^5",
           "spectral density of the jerk of what does so in another way each time")
      .Above(0.0);
  fields
      .Add("spin_density", &P::spin_density, "rad^2/s^3",
           "spectral density of angular accelerations")
      .Above(0.0);
  fields
      .Add("switching", &P::switching, "1/s",
           "how often what rests or goes straight changes its way")
      .Above(0.0);
  fields.Add("turning_end", &P::turning_end, "1/s", "how often anything else does").Above(0.0);
  fields
      .Add("prior_speed", &P::prior_speed, "m/s",
           "standard deviation along each axis of what comes into sight")
      .Above(0.0);
  fields.Add("fastest", &P::fastest, "m/s", "a pose that would take more is not believed at once")
      .Above(0.0);
}

ObstacleTracker::ObstacleTracker(const Params& params)
    : params_(Validated(params)),
      filter_(SettingsOf(params)),
      memory_(DeclareDiscreteState("tracks", TrackMemory(params.most_bodies))),
      in(DeclareInput<ObstacleSet>("in")),
      looked_(DeclareCached<&ObstacleTracker::CalcLooked>(kTime, in, memory_)),
      obstacles(DeclareOutput<ObstacleSet, &ObstacleTracker::CalcObstacles>("obstacles", {}, kTime,
                                                                            in, looked_)),
      tracks(
          DeclareOutput<TrackSet, &ObstacleTracker::CalcTracks>("tracks", {}, kTime, in, looked_)) {
  DeclareUpdate<&ObstacleTracker::Keep>(Every{params_.period}, Writes(memory_), looked_);
  DeclareRole(BlindSpots{.spots =
                             [](const std::string& own_name, bool /*one_robot*/) {
                               return std::vector<std::string>{
                                   fmt::format("obstacles but as '{}' estimates them", own_name)};
                             },
                         .behind = in});
}

double ObstacleTracker::SampledAt(double time, const ObstacleSet& set) const {
  return set.stamp.value_or(time) - params_.latency.seconds();
}

void ObstacleTracker::CalcLooked(double time, const ObstacleSet& set, const TrackMemory& memory,
                                 TrackMemory& looked) const {
  looked = memory;
  if (set.obstacles.empty() && !set.stamp && memory.bodies().empty()) return;  // none came in yet
  const double sampled = SampledAt(time, set);
  if (looked.looked && sampled <= *looked.looked) return;
  Look(sampled, set, looked);
}

void ObstacleTracker::Look(double sampled, const ObstacleSet& set, TrackMemory& memory) const {
  memory.looked = sampled;
  for (std::size_t i = 0; i < set.obstacles.size(); ++i) {
    const Obstacle& obstacle = set.obstacles[i];
    if (CameBefore(set, i)) continue;
    const int at = FindBody(memory, obstacle.body->id, i);
    if (at >= 0) {
      See(sampled, obstacle, memory.bodies()[static_cast<std::size_t>(at)]);
    } else if (!memory.full()) {
      TrackMemory::Body& body = memory.Add();
      body.body = obstacle.body;
      body.state = TrackState::kNew;
      body.seen = sampled;
      filter_.Start(sampled, obstacle.X_WO, body.track);
    }
  }
  for (TrackMemory::Body& body : memory.bodies()) {
    if (body.seen < sampled) body.state = TrackState::kLost;
  }
  memory.Forget(sampled, params_.keep_time);
}

void ObstacleTracker::See(double sampled, const Obstacle& obstacle, TrackMemory::Body& body) const {
  body.body = obstacle.body;  // another shape, it may be
  body.state = StateAfter(filter_.Update(sampled, obstacle.X_WO, body.track), body.state);
  body.seen = sampled;
}

void ObstacleTracker::CalcObstacles(double time, const ObstacleSet& set, const TrackMemory& looked,
                                    ObstacleSet& result) const {
  // As many may be without room as have one before that takes memory.
  const auto most = 2 * static_cast<std::size_t>(params_.most_bodies);
  result.obstacles.reserve(most);
  result.estimates.reserve(most);
  const auto bodies = looked.bodies();
  result.obstacles.resize(bodies.size());
  result.estimates.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    Obstacle& obstacle = result.obstacles[i];
    if (obstacle.body != bodies[i].body) obstacle.body = bodies[i].body;
    filter_.Tell(bodies[i].track, time, obstacle, result.estimates[i]);
  }
  const double age = std::max(time - SampledAt(time, set), 0.0);
  ForUntracked(set, looked, [&](const Obstacle& untracked) {
    Obstacle& obstacle = result.obstacles.emplace_back(untracked);
    obstacle.linear.setZero();
    obstacle.angular.setZero();
    obstacle.velocity_known = false;
    ObstacleEstimate& estimate = result.estimates.emplace_back();
    const double sideways = params_.prior_speed * age;
    estimate.covariance.topLeftCorner<3, 3>().diagonal().setConstant(
        params_.position_noise * params_.position_noise + sideways * sideways);
    estimate.age = age;
  });
}

void ObstacleTracker::CalcTracks(double time, const ObstacleSet& set, const TrackMemory& looked,
                                 TrackSet& result) const {
  result.tracks.reserve(2 * static_cast<std::size_t>(params_.most_bodies));
  result.tracks.clear();
  for (const TrackMemory::Body& body : looked.bodies()) {
    TrackReport report{body.body->id, body.state, std::max(time - body.track.time, 0.0),
                       body.track.nis};
    for (int i = 0; i < sensing::BodyTrack::kModes; ++i) {
      report.weights[i] = body.track.modes[static_cast<std::size_t>(i)].weight;
    }
    result.tracks.push_back(report);
  }
  const double age = std::max(time - SampledAt(time, set), 0.0);
  ForUntracked(set, looked, [&](const Obstacle& obstacle) {
    result.tracks.push_back({obstacle.body->id, TrackState::kNotTracked, age});
  });
}

}  // namespace oca::systems

namespace oca {

Fault Signal<systems::TrackMemory>::Check(const systems::TrackMemory& memory, Look /*look*/) {
  for (const systems::TrackMemory::Body& body : memory.bodies()) {
    for (const sensing::BodyTrack::Mode& mode : body.track.modes) {
      if (AllFinite(mode.mean.data(), 9) && AllFinite(mode.covariance.data(), 81)) continue;
      return FaultOf("track '{}': got a NaN or an infinity; expected finite numbers",
                     body.body->id.text());
    }
  }
  return {};
}

}  // namespace oca
