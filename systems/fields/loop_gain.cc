// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/loop_gain.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/model_links.h"

namespace oca::systems {

struct LoopGain::Estimate {
  double gain{0.0};
  std::vector<robot::GainContact> contacts;
  std::vector<Eigen::Isometry3d> reordered;
  std::optional<robot::LoopGainWorkspace> workspace;
};

void LoopGain::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  fields.Add("alpha", &Params::alpha, "", "of the mapping");
  fields.Add("method", &Params::method, "", "of the mapping");
  fields.Add("damping", &Params::damping, "m", "of the mapping").AtLeast(0.0);
  fields
      .Add("relaxation_time", &Params::relaxation_time, "s",
           "least relaxation time, where the loop would be stable with less")
      .AtLeast(0.0);
  fields
      .Add(
          "safety", &Params::safety, "",
          "factor on the time at which the loop is just stable; 2 is the fastest without overshoot")
      .AtLeast(1.0);
  AddControlPeriod(fields);
}

LoopGain::LoopGain(const Params& params, const ModelSet& models)
    : params_(Validated(params)),
      model_(MovableModel(models, params.model)),
      settings_(MappingSettingsOf(
          {.alpha = params.alpha, .method = params.method, .damping = params.damping})),
      slopes(DeclareInput<ContactSlopes>("slopes")),
      more_slopes(DeclareOptionalInput<ContactSlopes>("more_slopes")),
      links(DeclareInput<LinkPoses>("links")),
      estimate_(DeclareCached<&LoopGain::CalcEstimate>(slopes, more_slopes, links)),
      gain(DeclareOutput<Vector, &Estimate::gain>("gain", {1, Unit::Any()}, estimate_)),
      relaxation_time(
          DeclareOutput<Vector, &LoopGain::CalcTime>("relaxation_time", {1, "s"}, estimate_)) {}

void LoopGain::AddContacts(const ContactSlopes& from,
                           std::vector<robot::GainContact>& contacts) const {
  const double rate_weight = 2.0 / params_.period.seconds();
  for (const ContactSlope& contact : from.slopes) {
    const bool own = !contact.own_link.empty();
    // Either side of a pair of own links has an entry, and either one counts both sides.
    const double share = own ? 0.5 : 1.0;
    contacts.push_back({LinkNumber(*model_, contact.link, "slopes"), contact.point_on_link,
                        own ? LinkNumber(*model_, contact.own_link, "slopes") : -1,
                        contact.point_on_obstacle, contact.normal,
                        share * (contact.slope + rate_weight * contact.damping)});
  }
}

void LoopGain::CalcEstimate(const ContactSlopes& first, const ContactSlopes* second,
                            const LinkPoses& poses, Estimate& result) const {
  if (!result.workspace) result.workspace.emplace(*model_);
  result.contacts.clear();
  result.contacts.reserve(first.slopes.capacity() + (second ? second->slopes.capacity() : 0));
  AddContacts(first, result.contacts);
  if (second != nullptr) AddContacts(*second, result.contacts);
  const auto X_WL = PosesInOrder(*model_, poses, result.reordered);
  result.gain = robot::LoopGainOf(*model_, X_WL, result.contacts, settings_, *result.workspace);
}

void LoopGain::CalcTime(const Estimate& result, MutableVectorView value) const {
  const double least = robot::LeastRelaxationTime(result.gain, params_.period.seconds());
  value[0] = std::max(params_.relaxation_time, params_.safety * least);
}

}  // namespace oca::systems
