// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/batch_kernel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

// All of it is inlined into CheckLanes and CheckLanesPortable, so no vector is ever passed.
#pragma GCC diagnostic ignored "-Wpsabi"
#define OCA_INLINED inline __attribute__((always_inline))

namespace oca::planning::internal {
namespace {

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

OCA_INLINED void PlaceFrames(const BatchScene& scene, const LaneArray* motion,
                             BatchWorkspace& work) {
  LaneArray* const poses = work.frames.data();
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    const BatchFrame& frame = scene.frames[i];
    const Pose parent = LoadPose(poses + 12 * frame.parent);
    const std::array<float, 9>& R = frame.R;
    Pose X{Combine(parent, R[0], R[1], R[2]), Combine(parent, R[3], R[4], R[5]),
           Combine(parent, R[6], R[7], R[8]), Transform(parent, frame.p)};
    const Lanes moved = Load(motion[i]);
    if (frame.slides) {
      X.p = {X.p.x + X.w.x * moved, X.p.y + X.w.y * moved, X.p.z + X.w.z * moved};
    } else {
      Lanes s, c;
      SinCos(moved, s, c);
      const Point u = X.u, v = X.v;
      X.u = {c * u.x + s * v.x, c * u.y + s * v.y, c * u.z + s * v.z};
      X.v = {c * v.x - s * u.x, c * v.y - s * u.y, c * v.z - s * u.z};
    }
    LaneArray* const to = poses + 12 * (i + 1);
    StorePoint(X.u, to);
    StorePoint(X.v, to + 3);
    StorePoint(X.w, to + 6);
    StorePoint(X.p, to + 9);
  }
}

constexpr float kNever = -std::numeric_limits<float>::infinity();

/// A ball's margins: something may be nearer, or surely is.
struct Reach {
  float may, surely;
};

/// Where a ball about `at` is near a solid.
OCA_INLINED BatchAnswer NearSolid(const BatchSolid& solid, const Point& at, const Reach& reach) {
  const Point d{at.x - solid.centre[0], at.y - solid.centre[1], at.z - solid.centre[2]};
  const std::array<float, 9>& R = solid.R;
  const Lanes z = R[2] * d.x + R[5] * d.y + R[8] * d.z;
  const float may = reach.may + solid.radius;
  const float surely = reach.surely + solid.inner;
  if (solid.core == BatchCore::kPlane) return {MaskOf(!(z > may)), MaskOf(z < surely)};
  const float around = reach.may + solid.reach;
  if (MaskOf(!(SquaredNorm(d) > around * around)) == 0) return {0, 0};
  Point out{R[0] * d.x + R[3] * d.y + R[6] * d.z, R[1] * d.x + R[4] * d.y + R[7] * d.z,
            Positive(Abs(z) - solid.half[2])};
  if (solid.core == BatchCore::kCylinder) {
    const Lanes square = out.x * out.x + out.y * out.y;
    Lanes radial;
    for (int lane = 0; lane < kLanes; ++lane) radial[lane] = std::sqrt(square[lane]);
    out.x = Positive(radial - solid.half[0]);
    out.y = Lanes{};
  } else {
    out.x = Positive(Abs(out.x) - solid.half[0]);
    out.y = Positive(Abs(out.y) - solid.half[1]);
  }
  const Lanes square = SquaredNorm(out);
  const unsigned sure = surely > 0.0f ? MaskOf(square < surely * surely) : 0u;
  return {MaskOf(!(square > may * may)), sure};
}

/// Places the balls of a link, once.
OCA_INLINED void PlaceBalls(const BatchScene& scene, int number, BatchWorkspace& work) {
  unsigned char& done = work.done[static_cast<std::size_t>(number)];
  if (done != 0) return;
  done = 1;
  const BatchLink& link = scene.links[static_cast<std::size_t>(number)];
  const Pose X = LoadPose(work.frames.data() + 12 * link.frame);
  for (int ball = link.first; ball < link.last; ++ball) {
    StorePoint(Transform(X, scene.balls[static_cast<std::size_t>(ball)].centre),
               work.balls.data() + 3 * ball);
  }
}

OCA_INLINED void Note(int link, int body, int pair, unsigned lanes, BatchWorkspace& work) {
  if (!work.found.empty() && body >= 0) {
    BatchCandidate& last = work.found.back();
    if (last.link == link && last.body == body) {
      last.lanes |= lanes;
      return;
    }
  }
  work.found.push_back({link, body, pair, lanes});
}

OCA_INLINED bool IsIgnored(const BatchScene& scene, int link, int body) {
  for (const BatchIgnored& ignored : scene.ignored) {
    if (ignored.link == link && ignored.body == body) return true;
  }
  return false;
}

OCA_INLINED Reach ReachOf(const BatchBall& ball, float margin, float error) {
  return {margin + error + ball.radius, ball.inner > 0.0f ? margin - error + ball.inner : kNever};
}

/// Leaves the lanes that are surely decided out of the rest.
OCA_INLINED void CheckSolids(const BatchScene& scene, const BatchQuestion& question,
                             BatchWorkspace& work, BatchAnswer& answer) {
  for (int i = scene.moving; i < static_cast<int>(scene.links.size()); ++i) {
    const BatchLink& link = scene.links[static_cast<std::size_t>(i)];
    const Point centre = LoadPoint(work.centres.data() + 3 * i);
    const Reach around = ReachOf(link.around, question.margin, question.error);
    for (const BatchSolid& solid : scene.solids) {
      const unsigned asked = question.lanes & ~answer.surely;
      const unsigned near = NearSolid(solid, centre, around).open & asked;
      if (near == 0 || IsIgnored(scene, i, solid.body)) continue;
      PlaceBalls(scene, i, work);
      unsigned found = 0, surely = 0;
      for (int k = link.first; k < link.last && surely != near; ++k) {
        const BatchBall& ball = scene.balls[static_cast<std::size_t>(k)];
        const BatchAnswer one = NearSolid(solid, LoadPoint(work.balls.data() + 3 * k),
                                          ReachOf(ball, question.margin, question.error));
        found |= one.open & near;
        surely |= one.surely & near;
      }
      answer.open |= found;
      answer.surely |= surely;
      if ((found & ~surely) != 0) Note(i, solid.body, -1, found & ~surely, work);
      if (answer.surely == question.lanes) return;
    }
  }
}

/// Where two balls are near each other.
OCA_INLINED BatchAnswer NearEachOther(const Point& a, const Point& b, const Reach& reach) {
  const Point d{a.x - b.x, a.y - b.y, a.z - b.z};
  const Lanes square = SquaredNorm(d);
  const unsigned sure = reach.surely > 0.0f ? MaskOf(square < reach.surely * reach.surely) : 0u;
  return {MaskOf(!(square > reach.may * reach.may)), sure};
}

OCA_INLINED void CheckPairs(const BatchScene& scene, const BatchQuestion& question,
                            BatchWorkspace& work, BatchAnswer& answer) {
  for (std::size_t i = 0; i < scene.pairs.size() && answer.surely != question.lanes; ++i) {
    const BatchPair& pair = scene.pairs[i];
    const BatchLink& a = scene.links[static_cast<std::size_t>(pair.link)];
    const BatchLink& b = scene.links[static_cast<std::size_t>(pair.other)];
    const float margin = question.margin * pair.share;
    const Reach around{margin + question.error + a.around.radius + b.around.radius, kNever};
    const unsigned near = NearEachOther(LoadPoint(work.centres.data() + 3 * pair.link),
                                        LoadPoint(work.centres.data() + 3 * pair.other), around)
                              .open &
                          question.lanes & ~answer.surely;
    if (near == 0) continue;
    PlaceBalls(scene, pair.link, work);
    PlaceBalls(scene, pair.other, work);
    unsigned found = 0, surely = 0;
    for (int k = a.first; k < a.last && surely != near; ++k) {
      const BatchBall& ball = scene.balls[static_cast<std::size_t>(k)];
      const Point at = LoadPoint(work.balls.data() + 3 * k);
      const Reach reach = ReachOf(ball, margin, question.error);
      for (int m = b.first; m < b.last; ++m) {
        const BatchBall& other = scene.balls[static_cast<std::size_t>(m)];
        const bool known = reach.surely > 0.0f && other.inner > 0.0f;
        const BatchAnswer one =
            NearEachOther(at, LoadPoint(work.balls.data() + 3 * m),
                          {reach.may + other.radius, known ? reach.surely + other.inner : kNever});
        found |= one.open & near;
        surely |= one.surely & near;
      }
    }
    answer.open |= found;
    answer.surely |= surely;
    if ((found & ~surely) != 0) {
      Note(pair.link, -1, static_cast<int>(i), found & ~surely, work);
    }
  }
}

OCA_INLINED BatchAnswer Check(const BatchScene& scene, const BatchQuestion& question,
                              BatchWorkspace& work) {
  work.found.clear();
  std::fill(work.done.begin(), work.done.end(), static_cast<unsigned char>(0));
  PlaceFrames(scene, question.motion, work);
  for (std::size_t i = 0; i < scene.links.size(); ++i) {
    const BatchLink& link = scene.links[i];
    const Pose X = LoadPose(work.frames.data() + 12 * link.frame);
    StorePoint(Transform(X, link.around.centre), work.centres.data() + 3 * i);
  }
  BatchAnswer answer{0, 0};
  CheckSolids(scene, question, work, answer);
  CheckPairs(scene, question, work, answer);
  return answer;
}

#if defined(__x86_64__)
// Without FMA on purpose: fused products would round otherwise.
__attribute__((target("avx2"))) BatchAnswer CheckLanesAvx2(const BatchScene& scene,
                                                           const BatchQuestion& question,
                                                           BatchWorkspace& work) {
  return Check(scene, question, work);
}

const bool kHasAvx2 = __builtin_cpu_supports("avx2");
#endif

}  // namespace

BatchWorkspace::BatchWorkspace(const BatchScene& scene)
    : frames(12 * (scene.frames.size() + 1), LaneArray{}),
      centres(3 * scene.links.size()),
      balls(3 * scene.balls.size()),
      done(scene.links.size()) {
  for (const std::size_t one : {0, 4, 8}) frames[one].fill(1.0f);  // the base
  found.reserve(scene.links.size() * scene.solids.size() + scene.pairs.size());
}

BatchAnswer CheckLanesPortable(const BatchScene& scene, const BatchQuestion& question,
                               BatchWorkspace& work) {
  return Check(scene, question, work);
}

BatchAnswer CheckLanes(const BatchScene& scene, const BatchQuestion& question,
                       BatchWorkspace& work) {
#if defined(__x86_64__)
  if (kHasAvx2) return CheckLanesAvx2(scene, question, work);
#endif
  return CheckLanesPortable(scene, question, work);
}

}  // namespace oca::planning::internal
