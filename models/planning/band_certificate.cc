// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_certificate.h"

#include <algorithm>
#include <cmath>

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr double kLookSpan = 0.0625;  // s; of a first look
constexpr int kHalvings = 7;          // of a span, before it counts as not proved
constexpr double kLookReach = 0.3;    // m; what is farther need not be known
constexpr double kBetween = 2.0;      // accelerations between looks, times the largest at them
constexpr double kShareKept = 0.5;    // of what start or goal leave

/// What is asked where `left` is what start or goal leave, m.
double NeedOf(double left, double hard) {
  if (left >= hard) return hard;
  return left > 0.0 ? kShareKept * left : -robot::kUnlimited;
}

}  // namespace

BandCertificate::BandCertificate(robot::Clearance& clearance, double hard_distance,
                                 double own_reference)
    : clearance_(clearance),
      hard_(hard_distance),
      own_reference_(own_reference),
      bound_(clearance.model()),
      link_needs_(static_cast<std::size_t>(clearance.model().num_links())),
      own_needs_(clearance.own_pairs().size()),
      travel_(link_needs_.size()),
      path_(clearance.model().num_positions()) {}

BandCertificate::Look BandCertificate::At(double time) {
  Look look{time, VectorXd(path_.size()), VectorXd(path_.size()), VectorXd(path_.size()), 0, {},
            {}};
  VectorXd* const of[] = {&look.q, &look.v, &look.a};
  for (int d = 0; d < 3; ++d) {
    (*request_)(time, d, *of[d]);
    curve_->Add(time, d, *of[d]);
  }
  ++evaluations_;
  clearance_.MoveTo(look.q);
  const robot::NearPair pair = clearance_.Nearest(kLookReach);
  look.nearest = std::min(pair.distance / pair.scale, kLookReach);
  return look;
}

void BandCertificate::Measure(Look& look) {
  if (!look.links.empty()) return;
  look.links.resize(link_needs_.size());
  look.own.resize(own_needs_.size());
  clearance_.MoveTo(look.q);
  clearance_.LinkDistances(kLookReach, look.links);
  clearance_.OwnDistances(kLookReach, look.own);
}

void BandCertificate::SetNeeds(const Look& start, const Look& goal) {
  most_need_ = 0.0;
  for (std::size_t i = 0; i < link_needs_.size(); ++i) {
    link_needs_[i] = std::min(NeedOf(start.links[i], hard_), NeedOf(goal.links[i], hard_));
    most_need_ = std::max(most_need_, link_needs_[i]);
  }
  for (std::size_t i = 0; i < own_needs_.size(); ++i) {
    own_needs_[i] = std::min(NeedOf(start.own[i], hard_), NeedOf(goal.own[i], hard_));
    const double scale = clearance_.own_scales()[i];
    if (scale > 1.0) own_needs_[i] = std::min(own_needs_[i], own_reference_ / scale);
    most_need_ = std::max(most_need_, own_needs_[i]);
  }
}

double BandCertificate::Until(const BandRequest& request, const BandCurve& curve, double from) {
  request_ = &request;
  curve_ = &curve;
  Look first = At(from);
  Look goal = At(curve.end());
  Measure(first);
  Measure(goal);
  SetNeeds(first, goal);
  const auto spans =
      std::max(1L, static_cast<long>(std::ceil((curve.end() - from) / kLookSpan - 1e-6)));
  for (long i = 1; i <= spans; ++i) {
    Look second =
        i == spans
            ? goal
            : At(from + static_cast<double>(i) * (curve.end() - from) / static_cast<double>(spans));
    if (!Proved(first, second, 0)) return failed_;
    first = std::move(second);
  }
  return BandCheck::kNever;
}

bool BandCertificate::Proved(Look& first, Look& second, int depth) {
  if (Suffices(first, second)) return true;
  if (depth == kHalvings) {
    failed_ = first.time;
    return false;
  }
  Look middle = At(0.5 * (first.time + second.time));
  return Proved(first, middle, depth + 1) && Proved(middle, second, depth + 1);
}

bool BandCertificate::Suffices(Look& first, Look& second) {
  const double dt = second.time - first.time;
  VectorXd a = first.a.cwiseAbs().cwiseMax(second.a.cwiseAbs());
  VectorXd middle(a.size());
  (*request_)(0.5 * (first.time + second.time), 2, middle);
  curve_->Add(0.5 * (first.time + second.time), 2, middle);
  a = kBetween * a.cwiseMax(middle.cwiseAbs());
  path_ = (second.q - first.q).cwiseAbs();
  for (Eigen::Index j = 0; j < path_.size(); ++j) {
    if (std::fabs(first.v[j]) < a[j] * dt) path_[j] += 0.25 * a[j] * dt * dt;
  }
  clearance_.MoveTo(first.q);
  X_WL_.assign(clearance_.X_WL().begin(), clearance_.X_WL().end());
  bound_.Calc(X_WL_, path_, travel_);
  const double most = *std::max_element(travel_.begin(), travel_.end());
  if (0.5 * (first.nearest + second.nearest) - most >= most_need_) return true;
  Measure(first);
  Measure(second);
  for (std::size_t i = 0; i < link_needs_.size(); ++i) {
    if (0.5 * (first.links[i] + second.links[i] - travel_[i]) < link_needs_[i]) return false;
  }
  for (std::size_t i = 0; i < own_needs_.size(); ++i) {
    const auto& pair = clearance_.own_pairs()[i];
    if (0.5 * (first.own[i] + second.own[i]) >= own_needs_[i] + most) continue;
    const double travel = bound_.Between(X_WL_, path_, pair.first, pair.second);
    if (0.5 * (first.own[i] + second.own[i] - travel) < own_needs_[i]) return false;
  }
  return true;
}

}  // namespace oca::planning
