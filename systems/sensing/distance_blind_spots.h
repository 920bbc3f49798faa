// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/signals/model_set.h"

namespace oca::systems {

/// What a distance block does not look at, a phrase each: links without a collision shape, own
/// links, other models, pairs of `ignore`. `own_name`: of the block in its diagram; `one_robot`:
/// the diagram has no other, so that it is not named.
std::vector<std::string> DistanceBlindSpots(const BulletDistance::Params& params,
                                            const ModelSet& models, const std::string& own_name,
                                            bool one_robot);

}  // namespace oca::systems
