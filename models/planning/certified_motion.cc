// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/certified_motion.h"

#include <algorithm>
#include <bit>

namespace oca::planning {
namespace {

// Steps shorter than this share of the motion count as contact.
constexpr double kLeastShare = 1e-3;
// Of a shorter motion, rad and m, samples tell no more than the proof does.
constexpr double kShort = 0.1;

}  // namespace

CertifiedMotion::CertifiedMotion(robot::Clearance& clearance, double margin)
    : clearance_(clearance),
      margin_(margin),
      bound_(clearance.model()),
      q_(clearance.model().num_positions()),
      path_(clearance.model().num_positions()),
      samples_(clearance.model().num_positions(), BatchClearance::kLanes),
      distances_(static_cast<std::size_t>(clearance.model().num_links())),
      own_distances_(clearance.own_pairs().size()),
      travel_(static_cast<std::size_t>(clearance.model().num_links())),
      approach_(clearance.own_pairs().size()) {}

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
  const double seen = SampledShare(q_0, q_1);
  if (seen == 1.0) return ProvedShare(q_0, q_1);
  return seen == 0.0 ? 0.0 : seen * ProvedShare(q_0, q_0 + seen * (q_1 - q_0));
}

double CertifiedMotion::SampledShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                                     const Eigen::Ref<const Eigen::VectorXd>& q_1) {
  constexpr int kSamples = BatchClearance::kLanes;
  if ((q_1 - q_0).squaredNorm() < kShort * kShort) return 1.0;
  if (!batch_ || batch_version_ != clearance_.version()) {
    batch_.emplace(clearance_);
    batch_version_ = clearance_.version();
  }
  for (int i = 0; i < kSamples; ++i) {
    samples_.col(i) = q_0 + (i + 1.0) / kSamples * (q_1 - q_0);
  }
  ++evaluations_;
  const int clear = std::countr_one(batch_->Clear(samples_, kSamples, std::max(margin_, 0.0)));
  return static_cast<double>(std::min(clear, kSamples)) / kSamples;
}

double CertifiedMotion::ProvedShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
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
  for (std::size_t i = 0; i < approach_.size(); ++i) {
    const auto& pair = clearance_.own_pairs()[i];
    approach_[i] = bound_.Between(clearance_.X_WL(), path_, pair.first, pair.second);
  }
  // What is farther than the whole rest of the path can lead need not be known.
  for (std::size_t link = 0; link < travel_.size(); ++link) {
    distances_[link] = margin_ + travel_[link];
  }
  for (std::size_t i = 0; i < approach_.size(); ++i) {
    own_distances_[i] = margin_ / clearance_.own_scales()[i] + approach_[i];
  }
  clearance_.LinkDistances(distances_);
  clearance_.OwnDistances(own_distances_);
  // A share of the path costs at most that share of its travel: the bound grows faster than the
  // path.
  double share = 1.0;
  const auto limit = [&](double distance, double margin, double travel) {
    if (travel == 0.0 || distance >= margin + travel) return;
    share = std::min(share, std::max(distance - margin, 0.0) / travel);
  };
  for (std::size_t link = 0; link < travel_.size(); ++link) {
    limit(distances_[link], margin_, travel_[link]);
  }
  for (std::size_t i = 0; i < own_distances_.size(); ++i) {
    limit(own_distances_[i], margin_ / clearance_.own_scales()[i], approach_[i]);
  }
  return share;
}

}  // namespace oca::planning
