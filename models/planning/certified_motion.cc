// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/certified_motion.h"

#include <algorithm>

namespace oca::planning {
namespace {

// What is farther need not be known: the joints cannot go farther in one step.
constexpr double kFarthestLook = 0.5;
// Steps shorter than this share of the motion count as contact.
constexpr double kLeastShare = 1e-3;

}  // namespace

CertifiedMotion::CertifiedMotion(robot::Clearance& clearance, double margin)
    : clearance_(clearance),
      margin_(margin),
      bound_(clearance.model()),
      q_(clearance.model().num_positions()),
      path_(clearance.model().num_positions()),
      distances_(static_cast<std::size_t>(clearance.model().num_links())),
      own_distances_(clearance.own_pairs().size()),
      travel_(static_cast<std::size_t>(clearance.model().num_links())) {}

bool CertifiedMotion::Clear(const Eigen::Ref<const Eigen::VectorXd>& q) {
  ++evaluations_;
  clearance_.MoveTo(q);
  return !clearance_.NearerThan(margin_);
}

bool CertifiedMotion::Clear(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                            const Eigen::Ref<const Eigen::VectorXd>& q_1) {
  return Clear(q_1) && ClearShare(q_0, q_1) == 1.0;  // the end first: it says no at little cost
}

double CertifiedMotion::ClearShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                                   const Eigen::Ref<const Eigen::VectorXd>& q_1) {
  double share = 0.0;
  while (share < 1.0) {
    q_ = q_0 + share * (q_1 - q_0);
    path_ = (1.0 - share) * (q_1 - q_0).cwiseAbs();
    ++evaluations_;
    clearance_.MoveTo(q_);
    const double step = FreeShare() * (1.0 - share);
    if (step < std::min(kLeastShare, 1.0 - share)) return share;
    share = std::min(share + step, 1.0);
    if (1.0 - share < 1e-12) share = 1.0;
  }
  return share;
}

double CertifiedMotion::FreeShare() {
  bound_.Calc(clearance_.X_WL(), path_, travel_);
  clearance_.LinkDistances(margin_ + kFarthestLook, distances_);
  clearance_.OwnDistances(margin_ + kFarthestLook, own_distances_);
  // A share of the path costs at most that share of its travel: the bound grows faster than the
  // path.
  double share = 1.0;
  const auto limit = [&](double distance, double margin, double travel) {
    const double room = std::max(distance - margin, 0.0);
    if (travel > room) share = std::min(share, room / travel);
  };
  for (std::size_t link = 0; link < travel_.size(); ++link) {
    limit(distances_[link], margin_, travel_[link]);
  }
  for (std::size_t i = 0; i < own_distances_.size(); ++i) {
    const auto& pair = clearance_.own_pairs()[i];
    limit(own_distances_[i], margin_ / clearance_.own_scales()[i],
          bound_.Between(clearance_.X_WL(), path_, pair.first, pair.second));
  }
  return share;
}

}  // namespace oca::planning
