// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/batch_kernel.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "oca/models/planning/batch_lanes.h"

namespace oca::planning::internal {
namespace {

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

constexpr LaneArray kNowhere{};

/// How far a link may travel relative to a frame that carries it.
OCA_INLINED const LaneArray& TravelOf(const BatchScene& scene, const BatchQuestion& question,
                                      const BatchWorkspace& work, int link, int frame) {
  if (question.paths == nullptr) return kNowhere;
  return work.travels[static_cast<std::size_t>(link) * (scene.frames.size() + 1) +
                      static_cast<std::size_t>(frame)];
}

/// source robot::TravelBound
OCA_INLINED void PlaceTravels(const BatchScene& scene, const BatchQuestion& question,
                              BatchWorkspace& work) {
  for (std::size_t i = static_cast<std::size_t>(scene.moving); i < scene.links.size(); ++i) {
    const BatchLink& link = scene.links[i];
    LaneArray* const travels = work.travels.data() + i * (scene.frames.size() + 1);
    const Point centre = LoadPoint(work.centres.data() + 3 * i);
    Lanes sum{};
    Store(sum, travels[link.frame]);
    for (int at = link.frame; at > 0;) {
      const BatchFrame& frame = scene.frames[static_cast<std::size_t>(at) - 1];
      const Lanes path = Load(question.paths[at - 1]);
      if (frame.slides) {
        sum = sum + path;
      } else {
        const Pose X = LoadPose(work.frames.data() + 12 * at);
        const Point d{centre.x - X.p.x, centre.y - X.p.y, centre.z - X.p.z};
        const Point side{X.w.y * d.z - X.w.z * d.y, X.w.z * d.x - X.w.x * d.z,
                         X.w.x * d.y - X.w.y * d.x};
        sum = sum +
              path * (Sqrt(SquaredNorm(side)) + (link.around.radius + 2.0f * question.error) + sum);
      }
      at = frame.parent;
      Store(sum, travels[at]);
    }
  }
}

constexpr float kNever = -std::numeric_limits<float>::infinity();

/// A ball's margins: something may be nearer, or surely is.
struct Reach {
  Lanes may;
  float surely;
};

/// Where a ball about `at` is near a solid.
OCA_INLINED BatchAnswer NearSolid(const BatchSolid& solid, const Point& at, const Reach& reach) {
  const Point d{at.x - solid.centre[0], at.y - solid.centre[1], at.z - solid.centre[2]};
  const std::array<float, 9>& R = solid.R;
  const Lanes z = R[2] * d.x + R[5] * d.y + R[8] * d.z;
  const Lanes may = reach.may + solid.radius;
  const float surely = reach.surely + solid.inner;
  if (solid.core == BatchCore::kPlane) return {MaskOf(!(z > may)), MaskOf(z < surely)};
  const Lanes around = reach.may + solid.reach;
  if (MaskOf(!(SquaredNorm(d) > around * around)) == 0) return {0, 0};
  Point out{R[0] * d.x + R[3] * d.y + R[6] * d.z, R[1] * d.x + R[4] * d.y + R[7] * d.z,
            Positive(Abs(z) - solid.half[2])};
  if (solid.core == BatchCore::kCylinder) {
    const Lanes square = out.x * out.x + out.y * out.y;
    out.x = Positive(Sqrt(square) - solid.half[0]);
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

OCA_INLINED Reach ReachOf(const BatchBall& ball, const Lanes& travel, float margin,
                          const BatchQuestion& question) {
  const bool tells = ball.inner > 0.0f && !question.all;
  return {travel + (margin + question.error + ball.radius),
          tells ? margin - question.error + ball.inner : kNever};
}

/// Where two balls are near each other.
OCA_INLINED BatchAnswer NearEachOther(const Point& a, const Point& b, const Reach& reach) {
  const Point d{a.x - b.x, a.y - b.y, a.z - b.z};
  const Lanes square = SquaredNorm(d);
  const unsigned sure = reach.surely > 0.0f ? MaskOf(square < reach.surely * reach.surely) : 0u;
  return {MaskOf(!(square > reach.may * reach.may)), sure};
}

OCA_INLINED void CheckMovers(const BatchScene& scene, const BatchQuestion& question, int number,
                             const Reach& around, const Lanes& travel, BatchWorkspace& work,
                             BatchAnswer& answer) {
  const BatchLink& link = scene.links[static_cast<std::size_t>(number)];
  const Point centre = LoadPoint(work.centres.data() + 3 * number);
  for (std::size_t m = 0; m < scene.movers.size(); ++m) {
    const LaneArray* const mover = question.movers + 4 * m;
    const Point at = LoadPoint(mover);
    const Lanes radius = Load(mover[3]);
    const unsigned asked = question.lanes & ~answer.surely;
    const unsigned near = NearEachOther(centre, at, {around.may + radius, kNever}).open & asked;
    if (near == 0 || IsIgnored(scene, number, scene.movers[m].body)) continue;
    PlaceBalls(scene, number, work);
    unsigned found = 0;
    for (int k = link.first; k < link.last && found != near; ++k) {
      const BatchBall& ball = scene.balls[static_cast<std::size_t>(k)];
      const Reach reach = ReachOf(ball, travel, question.margin, question);
      found |= NearEachOther(LoadPoint(work.balls.data() + 3 * k), at, {reach.may + radius, kNever})
                   .open &
               near;
    }
    answer.open |= found;
    if (found != 0) Note(number, scene.movers[m].body, -1, found, work);
  }
}

/// Leaves the lanes that are surely decided out of the rest.
OCA_INLINED void CheckSolids(const BatchScene& scene, const BatchQuestion& question,
                             BatchWorkspace& work, BatchAnswer& answer) {
  for (int i = scene.moving; i < static_cast<int>(scene.links.size()); ++i) {
    const BatchLink& link = scene.links[static_cast<std::size_t>(i)];
    const Point centre = LoadPoint(work.centres.data() + 3 * i);
    const Lanes travel = Load(TravelOf(scene, question, work, i, 0));
    const Reach around = ReachOf(link.around, travel, question.margin, question);
    for (const BatchSolid& solid : scene.solids) {
      const unsigned asked = question.lanes & ~answer.surely;
      const unsigned near = NearSolid(solid, centre, around).open & asked;
      if (near == 0 || IsIgnored(scene, i, solid.body)) continue;
      PlaceBalls(scene, i, work);
      unsigned found = 0, surely = 0;
      for (int k = link.first; k < link.last && surely != near; ++k) {
        const BatchBall& ball = scene.balls[static_cast<std::size_t>(k)];
        const BatchAnswer one = NearSolid(solid, LoadPoint(work.balls.data() + 3 * k),
                                          ReachOf(ball, travel, question.margin, question));
        found |= one.open & near;
        surely |= one.surely & near;
      }
      answer.open |= found;
      answer.surely |= surely;
      if ((found & ~surely) != 0) Note(i, solid.body, -1, found & ~surely, work);
      if (answer.surely == question.lanes) return;
    }
    if (question.movers != nullptr) {
      CheckMovers(scene, question, i, around, travel, work, answer);
    }
  }
}

OCA_INLINED void CheckPairs(const BatchScene& scene, const BatchQuestion& question,
                            BatchWorkspace& work, BatchAnswer& answer) {
  for (std::size_t i = 0; i < scene.pairs.size() && answer.surely != question.lanes; ++i) {
    const BatchPair& pair = scene.pairs[i];
    const BatchLink& a = scene.links[static_cast<std::size_t>(pair.link)];
    const BatchLink& b = scene.links[static_cast<std::size_t>(pair.other)];
    const float margin = question.margin * pair.share;
    const Lanes travel = Load(TravelOf(scene, question, work, pair.link, pair.frame)) +
                         Load(TravelOf(scene, question, work, pair.other, pair.frame));
    const Reach around{travel + (margin + question.error + a.around.radius + b.around.radius),
                       kNever};
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
      const Reach reach = ReachOf(ball, travel, margin, question);
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
  if (question.paths != nullptr) PlaceTravels(scene, question, work);
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

std::atomic<bool> portable_alone{false};

}  // namespace

BatchWorkspace::BatchWorkspace(const BatchScene& scene)
    : frames(12 * (scene.frames.size() + 1), LaneArray{}),
      centres(3 * scene.links.size()),
      balls(3 * scene.balls.size()),
      travels(scene.links.size() * (scene.frames.size() + 1), LaneArray{}),
      done(scene.links.size()) {
  for (const std::size_t one : {0, 4, 8}) frames[one].fill(1.0f);  // the base
  found.reserve(scene.links.size() * (scene.solids.size() + scene.movers.size()) +
                scene.pairs.size());
}

void ForcePortable(bool portable) { portable_alone = portable; }

BatchAnswer CheckLanesPortable(const BatchScene& scene, const BatchQuestion& question,
                               BatchWorkspace& work) {
  return Check(scene, question, work);
}

BatchAnswer CheckLanes(const BatchScene& scene, const BatchQuestion& question,
                       BatchWorkspace& work) {
#if defined(__x86_64__)
  if (kHasAvx2 && !portable_alone.load(std::memory_order_relaxed)) {
    return CheckLanesAvx2(scene, question, work);
  }
#endif
  return CheckLanesPortable(scene, question, work);
}

}  // namespace oca::planning::internal
