// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/loop_gain.h"
#include "oca/systems/fields/jacobian_mapping.h"
#include "oca/systems/signals/contact_slopes.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// How long a DeltaRelaxation must take so that the loop through field, mapping and robot does not
/// chatter, from what is near at this tick:
///
///     relaxation_time = max(parameter relaxation_time, safety period (1 + gain) / 2)
///     gain = spectral radius of alpha M sum_i b_i(slope_i + 2 damping_i / period) b_i(normal_i)^T
///
/// as robot::LoopGainOf has it, with the M of the mapping: the parameters model, alpha, method and
/// damping must be those of the JacobianMapping in the loop. With `safety` 1 the loop is at the
/// bound, with 2 an error of the linear part is gone after one period; more is slower. A force that
/// answers to the rate of the distance counts like one that answers to the distance over half a
/// period, since the rate is that of the period before. Where the field is floored, its slope at
/// the floor counts.
///
/// in    slopes       ContactSlopes  of the field
/// in    more_slopes  ContactSlopes  optional; of a second field
/// in    links        LinkPoses
/// out   gain             1          of the unrelaxed loop; above 1 that one chatters
/// out   relaxation_time  1  s
/// state -
/// throws ConfigError if there is no such model, alpha is not finite, damping is negative or, in
///        method damped, 0, safety < 1, period is not positive or relaxation_time negative; while
///        running if a slope is of no link of the model
/// source docs/theory.md, Loop gain and relaxation
class LoopGain final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "estimates the gain of an avoidance loop, and how slow it must be to be stable",
      "relaxation_time = max(relaxation_time, safety period (1 + gain) / 2); gain = spectral "
      "radius "
      "of alpha M sum b slope b^T",
      ""};
  struct Params {
    std::string model{};
    double alpha{1.0};
    JacobianMapping::Method method{JacobianMapping::Method::kPseudoInverse};
    double damping{0.1};
    double relaxation_time{0.0};
    double safety{2.0};
    Period period{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.relaxation_time = 0.1, .period = Period(1, 100)}; }

  LoopGain(const Params& params, const ModelSet& models);

 private:
  const Params params_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const robot::MappingSettings settings_;
  void AddContacts(const ContactSlopes& from, std::vector<robot::GainContact>& contacts) const;
  struct Estimate;
  void CalcEstimate(const ContactSlopes& first, const ContactSlopes* second, const LinkPoses& poses,
                    Estimate& result) const;
  void CalcTime(const Estimate& result, MutableVectorView value) const;

 public:
  const Input<ContactSlopes> slopes;
  const OptionalInput<ContactSlopes> more_slopes;
  const Input<LinkPoses> links;

 private:
  const Cached<Estimate> estimate_;

 public:
  const Output<Vector> gain;
  const Output<Vector> relaxation_time;
};

}  // namespace oca::systems
