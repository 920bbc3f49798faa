// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/signals.h"
#include "tests/models/robot/law_scene.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {

// Arms and what is near them, for methods that choose joint velocities.

using robot::test::Above;
using robot::test::AroundBentArm;
using robot::test::BentArm;
using robot::test::Mirrored;
using robot::test::Moved;
using robot::test::Near;

inline LinkPoses PosesOf(const robot::RobotModel& model, const Eigen::VectorXd& q) {
  LinkPoses poses;
  NameLinks(model, poses);
  robot::ForwardKinematics(model, q, poses.poses);
  return poses;
}

/// A method S, with inputs proximities, links and wish, on a bench.
template <class S>
class MethodBench {
 public:
  explicit MethodBench(const typename S::Params& params, const std::string& name = "planar2",
                       const Eigen::Isometry3d& X_WB = Eigen::Isometry3d::Identity())
      : model_(LoadTestModel(name, X_WB)), bench_(params, Alone(name, model_)) {}

  Eigen::VectorXd Answer(const Eigen::VectorXd& q, const Eigen::VectorXd& wish,
                         const ProximitySet& set) {
    bench_->links.Fix(bench_.context(), PosesOf(*model_, q));
    return Answer(wish, set);
  }
  /// With the arm where it was.
  Eigen::VectorXd Answer(const Eigen::VectorXd& wish, const ProximitySet& set) {
    bench_->wish.Fix(bench_.context(), wish);
    bench_->proximities.Fix(bench_.context(), set);
    return bench_->velocity.Eval(bench_.context());
  }
  double share() { return bench_->share.Eval(bench_.context())[0]; }
  double rows() { return bench_->rows.Eval(bench_.context())[0]; }
  const robot::RobotModel& model() const { return *model_; }
  SystemBench<S>& bench() { return bench_; }

 private:
  static ModelSet Alone(const std::string& name,
                        const std::shared_ptr<const robot::RobotModel>& model) {
    ModelSet set;
    set.Add(name, model);
    return set;
  }
  const std::shared_ptr<const robot::RobotModel> model_;
  SystemBench<S> bench_;
};

}  // namespace oca::systems
