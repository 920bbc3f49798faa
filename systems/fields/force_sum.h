// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Lets two fields act together: the forces of both, those of forces0 first. Superposition is the
/// sum of their wrenches, so nothing is added up here.
///
/// in    forces0, forces1  LinkForceSet  N
/// out   forces            LinkForceSet  N
/// state -
/// source report eq. (2.6)
class ForceSum final : public System {
 public:
  static constexpr SystemDoc kDoc{"lets two fields of force act together",
                                  "forces = forces0 followed by forces1",
                                  "Khatib 1986; Jain, Sixt, Exner 2016, eq. (2.6)"};
  struct Params {
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {}; }

  explicit ForceSum(const Params& params);

 private:
  void CalcForces(const LinkForceSet& first, const LinkForceSet& second, LinkForceSet& sum) const;

 public:
  const Input<LinkForceSet> forces0;
  const Input<LinkForceSet> forces1;
  const Output<LinkForceSet> forces;
};

}  // namespace oca::systems
