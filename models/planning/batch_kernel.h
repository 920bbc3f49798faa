// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace oca::planning::internal {

// What BatchClearance looks at: numbers for eight configurations at once, in single precision, m
// and rad, about the robot's base. Every version does the same operations in the same order, none
// of them contracted, so that all give the same bits.

inline constexpr int kLanes = 8;
/// Of single precision, for a joint, with sine and cosine: see BatchClearance.
inline constexpr double kRounding = 2e-6;
using LaneArray = std::array<float, kLanes>;

/// The next number above.
inline float Above(double value) {
  return std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity());
}

/// A frame that a joint moves: X_PF = X, then the joint's turn about z, or slide along it. Frame 0
/// is the base, which is not listed.
struct BatchFrame {
  int parent;
  bool slides;
  std::array<float, 9> R;  // by columns
  std::array<float, 3> p;
};

struct BatchBall {
  std::array<float, 3> centre;  // in the link's frame
  float radius;
  float inner;  // of a ball about the centre that the link contains; 0: none
};

/// A link: a ball around it, and balls that together contain it.
struct BatchLink {
  int frame;
  BatchBall around;
  int first, last;  // of the balls
};

/// Core of a body as the kernel knows it; all points within `radius` of it belong to the body.
enum class BatchCore : std::uint8_t { kBox, kCylinder, kPlane };

/// A solid that stands. A point and a segment along z are boxes without extents.
struct BatchSolid {
  BatchCore core;
  int body;                     // whose it is, or part of; ascending
  std::array<float, 9> R;       // of the world's axes into the solid's, by columns
  std::array<float, 3> centre;  // of the core; of the ball around it
  std::array<float, 3> half;    // extents; of a cylinder radius, -, half the length
  float radius;                 // with what rounding may make of it
  float inner;                  // the same, of what it surely contains; minus infinity: not known
  float reach;                  // radius of a ball around all of it; infinite for a plane
};

/// A body that is elsewhere in each lane: what it is there is a ball, of BatchQuestion::movers.
struct BatchMover {
  int body;
};

struct BatchPair {
  int link, other;
  int frame;    // the last that carries both
  float share;  // of the margin that this pair has to keep
};

/// What shall not be looked at: a link and a body.
struct BatchIgnored {
  int link, body;
};

struct BatchScene {
  std::vector<BatchFrame> frames;  // from frame 1 on
  std::vector<BatchLink> links;
  std::vector<BatchBall> balls;
  std::vector<BatchPair> pairs;
  std::vector<BatchSolid> solids;
  std::vector<BatchMover> movers;  // by their bodies, ascending
  std::vector<BatchIgnored> ignored;
  int moving{0};  // links from this place on are moved by joints
};

/// What may be too near: a link and a body, or a pair of links (`body` -1), and in which lanes.
struct BatchCandidate {
  int link;
  int body;
  int pair;
  unsigned lanes;
};

/// Room for what a check needs.
struct BatchWorkspace {
  explicit BatchWorkspace(const BatchScene& scene);
  std::vector<LaneArray> frames;    // 12 each: columns of the rotation, position
  std::vector<LaneArray> centres;   // 3 a link
  std::vector<LaneArray> balls;     // 3 a ball
  std::vector<LaneArray> travels;   // of each link, m, relative to each frame that carries it
  std::vector<unsigned char> done;  // links whose balls are there
  std::vector<BatchCandidate> found;
};

/// What is nearer than `margin` (of an own pair, than its share of it) may be too near; with paths,
/// what is nearer than that and as far as links may travel.
struct BatchQuestion {
  const LaneArray* motion;  // of each frame's joint: angle from -pi to pi, or way
  const LaneArray* paths;   // that each frame's joint may go from there, either way; null: none
  const LaneArray* movers;  // of each a centre (3) and a radius
  float margin;
  float error;     // m, that distances may be wrong by
  unsigned lanes;  // that are asked for
  bool all;        // what surely is too near is asked for, too, as what may be
};

/// What is known of the lanes, a bit each: that something may be too near, and that it surely is,
/// without any travel.
struct BatchAnswer {
  unsigned open;  // lanes of `surely` included
  unsigned surely;
};

/// What a BatchClearance works on; a lane array a frame of motion and paths.
struct BatchKernel {
  BatchScene scene{};
  std::vector<LaneArray> motion{}, paths{};
  BatchWorkspace work{scene};
};

/// What may be too near is in `work.found`, of the lanes that are not surely decided, or of all;
/// how far links travel, if that was asked for, in `work.travels` (robot::TravelBound of the ball
/// around each).
BatchAnswer CheckLanes(const BatchScene& scene, const BatchQuestion& question,
                       BatchWorkspace& work);
/// Whether CheckLanes is to do without what only some processors have; for tests.
void ForcePortable(bool portable);
/// The same, by instructions that every processor has.
BatchAnswer CheckLanesPortable(const BatchScene& scene, const BatchQuestion& question,
                               BatchWorkspace& work);

}  // namespace oca::planning::internal
