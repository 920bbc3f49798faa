// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/gjk.h"

#include <algorithm>
#include <cmath>

#include "oca/models/geometry/contact_refinement.h"

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

constexpr int kMaxSteps = 128;
constexpr int kMaxIdleSteps = 4;
constexpr double kDirection = 4e-15;  // rounding of v, of the size, times the size over |v|
constexpr double kBlunt = 1e-9;       // of the size: a bound that costs a direction nothing
constexpr double kRefinable = 1e-5;   // of the size: from so near on a round contact is solved for
constexpr double kRefinableShare = 1e-3;  // the same, of |v|
constexpr double kStepRounding =
    1e-15;  // of a difference of support points, of the size of the pair

// The bodies may have moved such that a remembered triangle is worth little; it is a start still.
void Start(const CorePair& pair, const PairCache* cache, Simplex* simplex) {
  Simplex::Nearest nearest;
  if (cache && cache->count > 0) {
    for (int i = 0; i < std::min(cache->count, 3); ++i) {
      simplex->Add(pair.At(cache->points_a[i], cache->points_b[i]));
    }
  } else {
    const Vector3d centre = pair.Centre();
    simplex->Add(pair.Support(centre.isZero(0.0) ? Vector3d(Vector3d::UnitX()) : -centre));
  }
  simplex->FindNearest(false, &nearest);
  simplex->Keep(nearest);
}

void Remember(const Simplex& simplex, PairCache* cache) {
  if (!cache) return;
  cache->count = simplex.count();
  for (int i = 0; i < simplex.count(); ++i) {
    cache->points_a[i] = simplex.point(i).a;
    cache->points_b[i] = simplex.point(i).b;
  }
}

// `across` is the direction of the best lower bound: close to touch the last v may have none left.
CoreDistance Result(const CorePair& pair, const Simplex& simplex, double length, double lower,
                    const Vector3d& across) {
  return {std::max(length, lower), simplex.PointA(), pair.X_AB * simplex.PointB(),
          lower > 0.0 ? across : Vector3d(simplex.v() / length), std::max(length - lower, 0.0)};
}

bool Refine(const CorePair& pair, const Simplex& simplex, CoreDistance* found) {
  std::array<CorePair::Difference, 3> points;
  for (int i = 0; i < simplex.count(); ++i) points[i] = simplex.point(i);
  return RefineContact(pair, std::span(points.data(), simplex.count()), found);
}

// How wrong a bound may be and its direction still taken. The direction of a short v is rounded;
// only of round bodies does it come to mean nothing.
double DoubtOf(const CorePair& pair, double proof, double size, double length) {
  return proof + (pair.IsRound() ? std::min(kBlunt * size, 1e-6 * length)
                                 : kDirection * size * size / length);
}

}  // namespace

GjkStatus Gjk(const CorePair& pair, double max_distance, bool separated, PairCache* cache,
              CoreDistance* result, Simplex* last) {
  const double size = pair.Extent();
  // Flat faces end the search exactly; round ones only ever come closer.
  const double proof = (pair.IsRound() ? kRoundProof : kFlatProof) * size;
  Simplex own;
  Simplex& simplex = last ? *last : own;
  Start(pair, cache, &simplex);
  double length = simplex.v().norm();
  double lower = 0.0;
  Vector3d across = Vector3d::Zero();
  bool outside = separated, refined = !pair.IsRound();
  for (int step = 0, idle = 0; step < kMaxSteps; ++step) {
    if (length <= kTouch * size) break;
    const CorePair::Difference support = pair.Support(-simplex.v());
    const double bound = simplex.v().dot(support.w) / length;
    const double doubt = DoubtOf(pair, proof, size, length);
    if (bound > 0.0 && bound > lower - doubt) across = simplex.v() / length;
    if (bound > lower) lower = bound, outside = true;
    if (bound > max_distance) {
      Remember(simplex, cache);
      *result = Result(pair, simplex, length, bound, simplex.v() / length);
      result->distance = bound;
      return GjkStatus::kBeyond;
    }
    if (!refined && length - bound <= std::min(kRefinable * size, kRefinableShare * length)) {
      refined = true;
      CoreDistance found = Result(pair, simplex, length, lower, across);
      if (Refine(pair, simplex, &found)) {
        Remember(simplex, cache);
        *result = found;
        return found.distance > max_distance ? GjkStatus::kBeyond : GjkStatus::kSeparated;
      }
    }
    if (length - bound <= std::min(proof, 1e-6 * length)) break;
    if (simplex.Contains(support)) break;
    simplex.Add(support);
    Simplex::Nearest nearest;
    if (!simplex.FindNearest(outside, &nearest)) {  // the origin is inside
      if (cache) cache->count = 0;
      return GjkStatus::kTouching;
    }
    const double shorter = std::sqrt(nearest.squared);
    // A step may gain less than rounding shows, yet turn the simplex for the next one.
    if (shorter > length + kStepRounding * size || (shorter >= length && ++idle > kMaxIdleSteps)) {
      simplex.Drop();
      break;
    }
    simplex.Keep(nearest);
    length = shorter;
  }
  if (length <= kTouch * size) {
    if (cache) cache->count = 0;
    return GjkStatus::kTouching;
  }
  Remember(simplex, cache);
  *result = Result(pair, simplex, length, lower, across);
  if (pair.IsRound()) Refine(pair, simplex, result);
  return GjkStatus::kSeparated;
}

}  // namespace oca::geometry::internal
