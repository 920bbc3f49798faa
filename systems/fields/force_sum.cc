// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/force_sum.h"

#include "oca/systems/signals/roles.h"

namespace oca::systems {

void ForceSum::Params::Describe(Fields<Params>& /*fields*/) {}

ForceSum::ForceSum(const Params& /*params*/)
    : forces0(DeclareInput<LinkForceSet>("forces0")),
      forces1(DeclareInput<LinkForceSet>("forces1")),
      forces(DeclareOutput<LinkForceSet, &ForceSum::CalcForces>("forces", {}, forces0, forces1)) {
  DeclareRole(NotDrawn{forces});
}

void ForceSum::CalcForces(const LinkForceSet& first, const LinkForceSet& second,
                          LinkForceSet& sum) const {
  sum.forces.reserve(first.forces.capacity() + second.forces.capacity());
  sum.forces.assign(first.forces.begin(), first.forces.end());
  sum.forces.insert(sum.forces.end(), second.forces.begin(), second.forces.end());
}

}  // namespace oca::systems
