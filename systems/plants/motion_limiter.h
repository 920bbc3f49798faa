// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/motion/stoppable_motion.h"
#include "oca/systems/signals/model_set.h"

namespace oca::systems {

/// What a MotionLimiter took from the motion of one joint, and which limit made it do so. With
/// `yields` the joint came in a motion from which that limit cannot be kept any more.
struct MotionClip {
  int joint{0};  ///< from 0
  motion::MotionLimit limit{motion::MotionLimit::kNone};
  motion::MotionLimit yields{motion::MotionLimit::kNone};
  double amount{0.0};  ///< position minus request
};
/// JSON: [{"joint", "limit": "position" | "velocity" | "acceleration" | "jerk",
/// "yields": the same or "none", "amount"}]
struct MotionClips {
  std::vector<MotionClip> clips;
};

/// The last stage before the joints: whatever is requested, the joints are sent within the limits
/// of the model, at every tick, and so that they can always stop within them.
///
///     position = c + u period,   u = clamp(w + catch_up(r - c), range(c, v, a))
///
/// c, v, a are position, velocity and acceleration of the command at the last tick, r is the
/// request there and w = (request - r) / period its velocity. The range is that of
/// motion::StoppableVelocities: position, velocity, acceleration and jerk limits of the model, the
/// last two where it has any. A command that was held back, c != r, catches up no faster than it
/// can brake by half the acceleration (and half the jerk, if that is limited), so that it
/// meets the request at the request's own velocity instead of shooting past it. Each joint is
/// treated alone. The output follows from the input at once: it costs no delay, and a request
/// within the limits passes unchanged. The command is that of a joint which moves straight from
/// tick to tick, as with a deadbeat JointServo.
///
/// in    request            n  u    target for the end of the period, held between ticks
///       measured_position  n  u    optional; where the command starts, else at `request`
/// out   position  n  u
///       velocity  n  u/s           of the period: u
///       clips     MotionClips      the joints whose request was changed
/// state c         n  u
///       r         n  u
///       v         n  u/s           at the start 0
///       a         n  u/s^2         at the start 0
///       started   1                0 before the first tick, when the command rests
/// throws ConfigError if there is no such model, nothing of it moves or period is not positive
/// source models/motion/stoppable_motion.h
class MotionLimiter final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "keeps the limits of the joints, so that they can always stop",
      "position = c + period clamp(velocity of the request + catch-up, velocities from which c can "
      "stop)",
      ""};
  struct Params {
    std::string model{};
    Period period{};
    bool enabled{true};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100)}; }

  MotionLimiter(const Params& params, const ModelSet& models);

 private:
  struct Answer;
  const Params params_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const DiscreteState<Vector> c_;
  const DiscreteState<Vector> r_;
  const DiscreteState<Vector> v_;
  const DiscreteState<Vector> a_;
  const DiscreteState<Vector> started_;
  /// The command at the last tick, and the request there.
  struct Past {
    VectorView c, r, v, a, started;
  };
  Answer Answers(VectorView asked, const Past& past, Eigen::Index joint) const;
  double Wish(double asked, double c, double r, double v, const motion::JointLimits& limits) const;
  void Start(VectorView asked, std::optional<VectorView> measured, MutableVectorView c,
             MutableVectorView r) const;
  void Update(VectorView asked, VectorView command, VectorView rate, MutableVectorView c,
              MutableVectorView r, MutableVectorView v, MutableVectorView a,
              MutableVectorView started) const;
  void CalcPosition(VectorView asked, VectorView c, VectorView r, VectorView v, VectorView a,
                    VectorView started, MutableVectorView out) const;
  void CalcVelocity(VectorView asked, VectorView c, VectorView r, VectorView v, VectorView a,
                    VectorView started, MutableVectorView out) const;
  void CalcClips(VectorView asked, VectorView c, VectorView r, VectorView v, VectorView a,
                 VectorView started, MotionClips& out) const;

 public:
  const Input<Vector> request;
  const OptionalInput<Vector> measured_position;
  const Output<Vector> position;
  const Output<Vector> velocity;
  const Output<MotionClips> clips;
};

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::MotionClips> {
  static constexpr const char* kName = "MotionClips";
  static Fault Check(const systems::MotionClips& value, Look look);
  static void WriteJson(const systems::MotionClips& value, std::string& out);
};

}  // namespace oca
