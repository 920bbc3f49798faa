// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/models/geometry/core_pair.h"
#include "oca/models/geometry/distance.h"
#include "oca/models/geometry/simplex.h"

namespace oca::geometry::internal {

enum class GjkStatus {
  kSeparated,  ///< the result holds, `gap` says how well it is proved
  kBeyond,     ///< farther than asked; result.distance is a proved lower bound
  kTouching    ///< the cores overlap or are closer than kTouch of their size; no result
};

/// Below this distance, relative to the size of the pair, a difference vector has no direction
/// left.
inline constexpr double kTouch = 1e-10;
/// Proof that ends the search: upper less lower bound, relative to the size of the pair; of
/// polyhedra, and with a round side.
inline constexpr double kFlatProof = 1e-14;
inline constexpr double kRoundProof = 1e-12;

/// Distance of two separated cores. Starts from the simplex in `cache` (may be null) and leaves its
/// own there.
///
/// `separated` promises that a plane between the cores is known. `last` (may be null) is the
/// simplex at the end: of four points around the origin if those prove that the cores overlap.
/// Each step takes the support point w along -v: |v| is an upper bound of the distance, v.w / |v| a
/// lower one.
/// source Gilbert, Johnson, Keerthi 1988; van den Bergen 1999 (termination)
GjkStatus Gjk(const CorePair& pair, double max_distance, bool separated, PairCache* cache,
              CoreDistance* result, Simplex* last = nullptr);

}  // namespace oca::geometry::internal
