// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/certified_motion.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace oca::planning {
namespace {

constexpr int kLanes = BatchClearance::kLanes;
constexpr int kMostSamples = 1000;
// Pieces and samples, 2-norm of the joints, rad and m.
constexpr double kFirstPiece = 0.0625;
constexpr double kLeastPiece = 1e-4;   // that is not halved any more
constexpr double kLeastShare = 2e-5;   // the same of a motion
constexpr int kMostFirst = 256;        // pieces of a motion
constexpr std::size_t kUsually = 300;  // pieces at a time

int CountOf(double length, double spacing, int most) {
  if (!(length <= spacing * most)) return most;
  return std::max(static_cast<int>(std::ceil(length / spacing)), 1);
}

}  // namespace

CertifiedMotion::CertifiedMotion(robot::Clearance& clearance, double margin)
    : clearance_(clearance),
      margin_(margin),
      way_(clearance.model().num_positions()),
      samples_(clearance.model().num_positions(), kLanes),
      paths_(clearance.model().num_positions(), kLanes) {
  assert(margin >= 0.0);
  pieces_.reserve(kUsually);
}

BatchClearance& CertifiedMotion::batch() {
  if (!batch_ || batch_version_ != clearance_.version()) {
    batch_.emplace(clearance_);
    batch_version_ = clearance_.version();
  }
  return *batch_;
}

bool CertifiedMotion::Clear(const Eigen::Ref<const Eigen::VectorXd>& q) {
  ++evaluations_;
  clearance_.MoveTo(q);
  return !clearance_.NearerThan(margin_);
}

bool CertifiedMotion::Clear(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                            const Eigen::Ref<const Eigen::VectorXd>& q_1, double room) {
  return SamplesClear(q_0, q_1, kFirstPiece, room) && ProvedShare(q_0, q_1, true) == 1.0;
}

bool CertifiedMotion::SamplesClear(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                                   const Eigen::Ref<const Eigen::VectorXd>& q_1, double spacing,
                                   double room) {
  const int samples = CountOf((q_1 - q_0).norm(), spacing, kMostSamples);
  evaluations_ += (samples + kLanes - 1) / kLanes;
  return batch().SamplesClear(q_0, q_1, samples, margin_ + room);
}

double CertifiedMotion::ClearShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                                   const Eigen::Ref<const Eigen::VectorXd>& q_1) {
  return ProvedShare(q_0, q_1, false);
}

double CertifiedMotion::RoomOf(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                               const Eigen::Ref<const Eigen::VectorXd>& q_1, double most) {
  double room = most;
  for (const auto* q : {&q_0, &q_1}) {
    ++evaluations_;
    clearance_.MoveTo(*q);
    const double distance = clearance_.Nearest(margin_ + 2.0 * room).distance;
    room = std::clamp(0.5 * (distance - margin_), 0.0, room);
  }
  return room;
}

double CertifiedMotion::SampledShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                                     const Eigen::Ref<const Eigen::VectorXd>& q_1, double spacing,
                                     double room) {
  way_ = q_1 - q_0;
  const int count = CountOf(way_.norm(), spacing, kMostSamples);
  for (int first = 0; first < count; first += kLanes) {
    const int filled = std::min(kLanes, count - first);
    for (int i = 0; i < filled; ++i) {
      samples_.col(i) = q_0 + (first + i + 1.0) / count * way_;
    }
    ++evaluations_;
    const int clear = batch().CountClear(samples_, filled, margin_ + room);
    if (clear < filled) return static_cast<double>(first + clear) / count;
  }
  return 1.0;
}

double CertifiedMotion::ProvedShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                                    const Eigen::Ref<const Eigen::VectorXd>& q_1, bool all) {
  way_ = q_1 - q_0;
  const double length = way_.norm();
  const double least = std::max(kLeastPiece / std::max(length, kLeastPiece), kLeastShare);
  const int first = CountOf(length, kFirstPiece, kMostFirst);
  pieces_.clear();
  for (int i = first; i > 0; --i) pieces_.push_back({(i - 1.0) / first, 1.0 * i / first});
  std::array<Piece, kLanes> looked{};
  double proved = 1.0;
  while (!pieces_.empty() && (proved == 1.0 || !all)) {
    int count = 0;
    while (count < kLanes && !pieces_.empty()) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      if (piece.from >= proved) continue;
      samples_.col(count) = q_0 + 0.5 * (piece.from + piece.to) * way_;
      paths_.col(count) = 0.5 * (piece.to - piece.from) * way_.cwiseAbs();
      looked[static_cast<std::size_t>(count++)] = piece;
    }
    if (count == 0) break;
    ++evaluations_;
    const BatchClearance::Around around = batch().ClearAround(samples_, paths_, count, margin_);
    for (int i = count - 1; i >= 0; --i) {
      if ((around.clear >> i & 1u) != 0) continue;
      const Piece& piece = looked[static_cast<std::size_t>(i)];
      const double middle = 0.5 * (piece.from + piece.to);
      const bool contact = (around.contact >> i & 1u) != 0;
      if (contact) proved = std::min(proved, middle);
      if (piece.to - piece.from < 2.0 * least) {
        proved = std::min(proved, piece.from);
        continue;
      }
      if (!contact) pieces_.push_back({middle, piece.to});
      pieces_.push_back({piece.from, middle});
    }
  }
  return proved;
}

}  // namespace oca::planning
