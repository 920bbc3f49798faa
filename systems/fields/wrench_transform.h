// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Moves forces at points of links to the joints that carry the links:
///
///     f = sum F,   tau = sum (p - o) x F
///
/// over all forces F at p on one body, o the origin of the body's link, which lies on its joint. A
/// link on fixed joints belongs to the last movable joint before it; links that cannot move get no
/// wrench. `wrenches_in_link` is a view of the same wrenches in the axes of their links, about
/// their origins; mappings use the world axes.
///
/// in    forces            LinkForceSet  N
/// in    links             LinkPoses
/// out   wrenches          WrenchSet     N, Nm  one a body that a force acts on, world axes
/// out   wrenches_in_link  WrenchSet     N, Nm  the same in the frames of the links
/// state -
/// throws while running if a force acts on a link whose pose does not come in
/// source report section 3.3; docs/theory.md
class WrenchTransform final : public System {
 public:
  static constexpr SystemDoc kDoc{"moves forces on links to the joints that carry the links",
                                  "force = sum F, torque = sum (point - origin) x F",
                                  "Jain, Sixt, Exner 2016, section 3.3"};
  struct Params {
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {}; }

  explicit WrenchTransform(const Params& params);

 private:
  void CalcWrenches(const LinkForceSet& force_set, const LinkPoses& poses,
                    WrenchSet& wrench_set) const;
  void CalcInLink(const WrenchSet& in_world, const LinkPoses& poses, WrenchSet& in_link) const;

 public:
  const Input<LinkForceSet> forces;
  const Input<LinkPoses> links;
  const Output<WrenchSet> wrenches;
  const Output<WrenchSet> wrenches_in_link;
};

}  // namespace oca::systems
