// SPDX-License-Identifier: BSD-3-Clause
// Numbers and poses of eight configurations at once, for batch_kernel.cc alone.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "oca/models/planning/batch_kernel.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

// All of it is inlined into CheckLanes and CheckLanesPortable, so no vector is ever passed.
#pragma GCC diagnostic ignored "-Wpsabi"
#define OCA_INLINED inline __attribute__((always_inline))

namespace oca::planning::internal {

using Lanes = float __attribute__((vector_size(32)));
using Bits = std::int32_t __attribute__((vector_size(32)));

OCA_INLINED Lanes Load(const LaneArray& from) {
  Lanes lanes;
  std::memcpy(&lanes, from.data(), sizeof lanes);
  return lanes;
}

OCA_INLINED void Store(const Lanes& lanes, LaneArray& to) {
  std::memcpy(to.data(), &lanes, sizeof lanes);
}

/// A bit a lane.
OCA_INLINED unsigned MaskOf(const Bits& bits) {
#if defined(__SSE2__)
  __m128 half[2];
  std::memcpy(half, &bits, sizeof half);
  return static_cast<unsigned>(_mm_movemask_ps(half[0]) | (_mm_movemask_ps(half[1]) << 4));
#else
  unsigned mask = 0;
  for (int lane = 0; lane < kLanes; ++lane) mask |= bits[lane] < 0 ? 1u << lane : 0u;
  return mask;
#endif
}

OCA_INLINED Lanes Abs(const Lanes& x) {
  return std::bit_cast<Lanes>(std::bit_cast<Bits>(x) & 0x7fffffff);
}

/// Rounded as IEEE 754 says, like all else.
OCA_INLINED Lanes Sqrt(const Lanes& x) {
  Lanes root;
#if defined(__SSE2__)
  __m128 half[2];
  std::memcpy(half, &x, sizeof half);
  half[0] = _mm_sqrt_ps(half[0]);
  half[1] = _mm_sqrt_ps(half[1]);
  std::memcpy(&root, half, sizeof root);
#else
  for (int lane = 0; lane < kLanes; ++lane) root[lane] = std::sqrt(x[lane]);
#endif
  return root;
}

/// The part above 0; of NaN, NaN.
OCA_INLINED Lanes Positive(const Lanes& x) { return x < 0.0f ? Lanes{} : x; }

struct Point {
  Lanes x, y, z;
};

OCA_INLINED Lanes SquaredNorm(const Point& p) { return p.x * p.x + p.y * p.y + p.z * p.z; }

/// For angles from -pi to pi, to 1e-7. source Cephes, sinf.c
OCA_INLINED void SinCos(const Lanes& angle, Lanes& sine, Lanes& cosine) {
  constexpr float kRound = 12582912.0f;  // 1.5 * 2^23: to add it rounds
  const Lanes turns = (angle * 0.63661977f + kRound) - kRound;
  const Bits quarter = __builtin_convertvector(turns, Bits);
  const Lanes r = ((angle - turns * 1.5703125f) - turns * 4.837512969970703125e-4f) -
                  turns * 7.549789948768648e-8f;
  const Lanes z = r * r;
  const Lanes s = r + r * z * (-1.6666654611e-1f + z * (8.3321608736e-3f + z * -1.9515295891e-4f));
  const Lanes c =
      1.0f - 0.5f * z +
      z * z * (4.166664568298827e-2f + z * (-1.388731625493765e-3f + z * 2.443315711809948e-5f));
  const Bits swapped = (quarter & 1) != 0;
  const Lanes sine_part = swapped ? c : s;
  const Lanes cosine_part = swapped ? s : c;
  sine = (quarter & 2) != 0 ? -sine_part : sine_part;
  cosine = ((quarter + 1) & 2) != 0 ? -cosine_part : cosine_part;
}

/// A pose in each lane: columns of the rotation, position.
struct Pose {
  Point u, v, w, p;
};

OCA_INLINED Point Combine(const Pose& X, float a, float b, float c) {
  return {X.u.x * a + X.v.x * b + X.w.x * c, X.u.y * a + X.v.y * b + X.w.y * c,
          X.u.z * a + X.v.z * b + X.w.z * c};
}

OCA_INLINED Point Transform(const Pose& X, const std::array<float, 3>& point) {
  const Point turned = Combine(X, point[0], point[1], point[2]);
  return {turned.x + X.p.x, turned.y + X.p.y, turned.z + X.p.z};
}

OCA_INLINED void StorePoint(const Point& point, LaneArray* to) {
  Store(point.x, to[0]);
  Store(point.y, to[1]);
  Store(point.z, to[2]);
}

OCA_INLINED Point LoadPoint(const LaneArray* from) {
  return {Load(from[0]), Load(from[1]), Load(from[2])};
}

OCA_INLINED Pose LoadPose(const LaneArray* from) {
  return {LoadPoint(from), LoadPoint(from + 3), LoadPoint(from + 6), LoadPoint(from + 9)};
}

}  // namespace oca::planning::internal
