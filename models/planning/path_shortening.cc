// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/path_shortening.h"

#include <utility>

#include "oca/models/planning/certified_motion.h"
#include "oca/models/planning/tree_pair.h"

namespace oca::planning {

PathShortening::PathShortening(Path path, double margin, std::uint64_t seed, int tries)
    : path_(std::move(path)),
      margin_(margin),
      random_(models::Random::Seed(seed, "shorten")),
      left_(tries) {}

void PathShortening::Continue(robot::Clearance& clearance, long most, long& evaluations) {
  if (done()) return;
  CertifiedMotion motion(clearance, margin_);
  // Whatever is nearer takes long to prove.
  const double room = motion.RoomOf(path_.front(), path_.back(), kSampleRoom);
  for (; !done() && motion.evaluations() < most; --left_) {
    // Two points on different edges, anywhere on them.
    std::size_t a = random_.Below(path_.size() - 1);
    std::size_t b = random_.Below(path_.size() - 1);
    if (a == b) continue;
    if (a > b) std::swap(a, b);
    const Eigen::VectorXd from = path_[a] + random_.Unit() * (path_[a + 1] - path_[a]);
    const Eigen::VectorXd to = path_[b] + random_.Unit() * (path_[b + 1] - path_[b]);
    if (!motion.Clear(from, to, room)) continue;
    Path shorter(path_.begin(), path_.begin() + static_cast<std::ptrdiff_t>(a) + 1);
    shorter.push_back(from);
    shorter.push_back(to);
    shorter.insert(shorter.end(), path_.begin() + static_cast<std::ptrdiff_t>(b) + 1, path_.end());
    path_ = std::move(shorter);
  }
  evaluations += motion.evaluations();
}

bool PathShortening::MoveStart(robot::Clearance& clearance, const Eigen::VectorXd& start,
                               long& evaluations) {
  CertifiedMotion motion(clearance, margin_);
  bool clear = path_.size() > 1 && motion.Clear(start, path_[1]);
  if (clear) {
    path_.front() = start;
  } else {
    clear = motion.Clear(start, path_.front());
    if (clear) path_.insert(path_.begin(), start);
  }
  evaluations += motion.evaluations();
  return clear;
}

}  // namespace oca::planning
