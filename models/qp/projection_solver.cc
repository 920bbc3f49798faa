// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/qp/projection_solver.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace oca::qp {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
// Of the numbers that make up one residual, at least of 1: far above rounding, far below anything
// that a joint can do.
constexpr double kTolerance = 1e-12;
// Relative, what a proof of optimality may leave open.
constexpr double kProof = 1e-9;
// Squared sine of the angle below which a normal counts as a combination of the active ones.
constexpr double kDependent = 1e-18;

}  // namespace

ProjectionSolver::ProjectionSolver(int num_variables, int most_rows)
    : iteration_limit(5 * (most_rows + 2 * num_variables)),
      n_(num_variables),
      normals_(Eigen::MatrixXd::Zero(most_rows, n_)),
      offsets_(Eigen::VectorXd::Zero(most_rows)),
      lengths_(Eigen::VectorXd::Zero(most_rows)),
      residuals_(Eigen::VectorXd::Zero(most_rows)),
      scale_(Eigen::VectorXd::Zero(n_)),
      lower_(scale_),
      upper_(scale_),
      x_(scale_),
      normal_(scale_),
      error_(scale_),
      correction_(scale_),
      multipliers_(Eigen::VectorXd::Zero(most_rows + 2 * n_)),
      caps_(multipliers_),
      places_(static_cast<std::size_t>(most_rows + 2 * n_)),
      factor_(n_) {
  active_.reserve(static_cast<std::size_t>(n_));
  guess_.reserve(places_.size());
}

bool ProjectionSolver::Valid(const ProjectionQp& qp) const {
  if (qp.num_rows < 0 || qp.num_rows > qp.most_rows()) return false;
  const auto rows = qp.rows.topRows(qp.num_rows);
  return qp.wish.allFinite() && rows.allFinite() && qp.bounds.head(qp.num_rows).allFinite() &&
         qp.penalties.head(qp.num_rows).allFinite() &&
         (qp.penalties.head(qp.num_rows).array() >= 0.0).all() && qp.weights.allFinite() &&
         (qp.weights.array() > 0.0).all() && (qp.lower.array() <= qp.upper.array()).all() &&
         (qp.lower.array() < kUnbounded).all() && (qp.upper.array() > -kUnbounded).all();
}

/// False if a number overflows, of which nothing more could be said.
bool ProjectionSolver::Scale(const ProjectionQp& qp) {
  m_ = qp.num_rows;
  scale_ = qp.weights.array().rsqrt();
  lower_ = (qp.lower - qp.wish).cwiseQuotient(scale_);
  upper_ = (qp.upper - qp.wish).cwiseQuotient(scale_);
  auto normals = normals_.topRows(m_);
  auto lengths = lengths_.head(m_);
  auto offsets = offsets_.head(m_);
  offsets = qp.bounds.head(m_);
  lengths.setZero();
  for (int j = 0; j < n_; ++j) {
    offsets -= qp.wish[j] * qp.rows.col(j).head(m_);
    normals.col(j) = scale_[j] * qp.rows.col(j).head(m_);
    lengths += normals.col(j).cwiseAbs2();
  }
  lengths = lengths.cwiseSqrt();
  caps_.head(m_) = qp.penalties.head(m_).cwiseProduct(lengths);
  caps_.segment(m_, 2 * n_).setConstant(kUnbounded);
  multipliers_.head(m_ + 2 * n_).setZero();
  std::fill_n(places_.begin(), m_ + 2 * n_, Place::kFree);
  for (int i = 0; i < m_; ++i) {
    // A row that no u changes: it has nothing to say about u.
    if (!(lengths[i] > 0.0)) places_[static_cast<std::size_t>(i)] = Place::kIgnored;
  }
  for (int j = 0; j < n_; ++j) {
    normals.col(j).array() /= lengths.array().max(std::numeric_limits<double>::min());
  }
  offsets.array() /= lengths.array().max(std::numeric_limits<double>::min());
  return lengths.allFinite() && offsets.allFinite() && caps_.head(m_).allFinite();
}

double ProjectionSolver::Residual(int constraint) const {
  if (constraint < m_) return normals_.row(constraint).dot(x_) - offsets_[constraint];
  const int j = constraint - m_;
  return j < n_ ? x_[j] - lower_[j] : upper_[j - n_] - x_[j - n_];
}

double ProjectionSolver::Tolerance(int constraint) const {
  if (constraint >= m_) {
    const int j = (constraint - m_) % n_;
    const double side = constraint - m_ < n_ ? lower_[j] : upper_[j];
    return kTolerance * std::max(1.0, std::fabs(side));
  }
  const double products = normals_.row(constraint).cwiseAbs().dot(x_.cwiseAbs());
  return kTolerance * std::max({1.0, products, std::fabs(offsets_[constraint])});
}

double ProjectionSolver::Wrong(int constraint, double residual) const {
  const Place place = places_[static_cast<std::size_t>(constraint)];
  const double wrong = place == Place::kFree       ? -residual
                       : place == Place::kGivesWay ? residual
                                                   : 0.0;
  return wrong > kTolerance && wrong > Tolerance(constraint) ? wrong : 0.0;
}

int ProjectionSolver::NextOfGuess() {
  while (guessed_ < guess_.size()) {
    const int constraint = guess_[guessed_++];
    if (Wrong(constraint, Residual(constraint)) > 0.0) return constraint;
  }
  return -1;
}

int ProjectionSolver::MostViolated() {
  auto residuals = residuals_.head(m_);
  residuals = -offsets_.head(m_);
  for (int j = 0; j < n_; ++j) residuals += x_[j] * normals_.col(j).head(m_);
  int worst = -1;
  double most = 0.0;
  const auto look = [&](int constraint, double residual) {
    const double wrong = Wrong(constraint, residual);
    if (wrong > most) {
      most = wrong;
      worst = constraint;
    }
  };
  for (int i = 0; i < m_; ++i) look(i, residuals[i]);
  for (int j = 0; j < n_; ++j) {
    look(m_ + j, x_[j] - lower_[j]);
    look(m_ + n_ + j, upper_[j] - x_[j]);
  }
  return worst;
}

void ProjectionSolver::LoadNormal(int constraint) {
  if (constraint < m_) {
    normal_ = normals_.row(constraint).transpose();
    return;
  }
  normal_.setZero();
  const int j = constraint - m_;
  normal_[j < n_ ? j : j - n_] = j < n_ ? 1.0 : -1.0;
}

/// How far the multiplier of `constraint` can go in `direction` (+-1) before it or an active one
/// reaches an end of [0, cap].
ProjectionSolver::Step ProjectionSolver::LongestStep(int constraint, double direction) const {
  Step step{
      direction > 0.0 ? caps_[constraint] - multipliers_[constraint] : multipliers_[constraint],
      -1};
  for (int k = 0; k < factor_.size(); ++k) {
    const int other = active_[static_cast<std::size_t>(k)];
    const double rate = -direction * factor_.coefficients()[k];
    double length = kUnbounded;
    if (rate < 0.0) length = multipliers_[other] / -rate;
    if (rate > 0.0) length = (caps_[other] - multipliers_[other]) / rate;
    if (length < step.length) step = {std::max(length, 0.0), k};
  }
  return step;
}

void ProjectionSolver::Leave(int active) {
  const auto at = active_.begin() + active;
  // It has just reached one end of its range, to within rounding.
  const bool gives_way = multipliers_[*at] > 0.5 * caps_[*at];
  multipliers_[*at] = gives_way ? caps_[*at] : 0.0;
  places_[static_cast<std::size_t>(*at)] = gives_way ? Place::kGivesWay : Place::kFree;
  active_.erase(at);
  factor_.Remove(active);
}

/// Brings the constraint to its bound, or its multiplier to the end of its range.
void ProjectionSolver::Enforce(int constraint, QpSolution& solution) {
  Place& place = places_[static_cast<std::size_t>(constraint)];
  const double direction = place == Place::kFree ? 1.0 : -1.0;
  LoadNormal(constraint);
  for (; solution.iterations < iteration_limit; ++solution.iterations) {
    factor_.Project(normal_);
    const double square = factor_.squared_length();
    const bool moves = factor_.size() < n_ && square > kDependent;
    const double whole =
        moves ? std::max(-direction * Residual(constraint), 0.0) / square : kUnbounded;
    Step step = LongestStep(constraint, direction);
    const bool arrives = whole <= step.length;
    if (arrives) step.length = whole;
    if (step.length == kUnbounded) {  // contradicts the box by no more than rounding
      place = Place::kIgnored;
      return;
    }
    if (moves) x_ += direction * step.length * factor_.direction();
    multipliers_[constraint] += direction * step.length;
    for (int k = 0; k < factor_.size(); ++k) {
      multipliers_[active_[static_cast<std::size_t>(k)]] -=
          direction * step.length * factor_.coefficients()[k];
    }
    if (arrives) {
      factor_.AddProjected();
      active_.push_back(constraint);
      place = Place::kActive;
      return;
    }
    if (step.blocking < 0) {
      place = direction > 0.0 ? Place::kGivesWay : Place::kFree;
      multipliers_[constraint] = direction > 0.0 ? caps_[constraint] : 0.0;
      return;
    }
    Leave(step.blocking);
  }
}

/// Removes the rounding that the steps have piled up: x anew from the multipliers, then the active
/// constraints met to the last bits.
void ProjectionSolver::Refine() {
  x_.setZero();
  for (int i = 0; i < m_ + 2 * n_; ++i) {
    if (multipliers_[i] == 0.0) continue;
    LoadNormal(i);
    x_ += multipliers_[i] * normal_;
  }
  for (int k = 0; k < factor_.size(); ++k) {
    error_[k] = -Residual(active_[static_cast<std::size_t>(k)]);
  }
  factor_.SolveTransposed(error_, correction_);
  x_ += correction_;
  for (int k = 0; k < factor_.size(); ++k) {
    const int i = active_[static_cast<std::size_t>(k)];
    multipliers_[i] = std::clamp(multipliers_[i] + error_[k], 0.0, caps_[i]);
  }
}

void ProjectionSolver::Report(const ProjectionQp& qp, QpSolution& solution) const {
  solution.u = qp.wish + scale_.cwiseProduct(x_);
  for (const int constraint : active_) {
    const int j = constraint - m_;
    if (j >= 0) solution.u[j % n_] = j < n_ ? qp.lower[j] : qp.upper[j - n_];
  }
  solution.u = solution.u.cwiseMax(qp.lower).cwiseMin(qp.upper);
  solution.active.clear();
  for (int i = 0; i < m_ + 2 * n_; ++i) {
    if (multipliers_[i] == 0.0) continue;
    if (i < m_) {
      const double slack = std::max(qp.bounds[i] - qp.rows.row(i).dot(solution.u), 0.0);
      const bool gives_way = places_[static_cast<std::size_t>(i)] == Place::kGivesWay;
      const double multiplier = gives_way ? qp.penalties[i] : multipliers_[i] / lengths_[i];
      solution.active.push_back({QpActive::Kind::kRow, i, std::min(multiplier, qp.penalties[i]),
                                 gives_way ? slack : 0.0});
    } else {
      const int j = (i - m_) % n_;
      const auto kind = i - m_ < n_ ? QpActive::Kind::kLower : QpActive::Kind::kUpper;
      solution.active.push_back({kind, j, multipliers_[i] / scale_[j], 0.0});
    }
  }
}

void ProjectionSolver::Solve(const ProjectionQp& qp, QpSolution& solution) {
  assert(qp.num_variables() == n_ && qp.most_rows() <= normals_.rows());
  solution.iterations = 0;
  if (!Valid(qp) || !Scale(qp)) {
    solution.status = QpStatus::kInvalid;
    for (int j = 0; j < n_; ++j) {
      const double nearest = std::min(std::max(0.0, qp.lower[j]), qp.upper[j]);
      solution.u[j] = std::isfinite(nearest) ? nearest : 0.0;
    }
    solution.active.clear();
    solution.kkt_residual = solution.relative_residual = solution.gap = kUnbounded;
    return;
  }
  guess_.clear();
  guessed_ = 0;
  for (const QpActive& active : solution.active) {
    const int first = active.kind == QpActive::Kind::kRow     ? 0
                      : active.kind == QpActive::Kind::kLower ? m_
                                                              : m_ + n_;
    const int count = active.kind == QpActive::Kind::kRow ? m_ : n_;
    if (active.index >= 0 && active.index < count) guess_.push_back(first + active.index);
  }
  x_.setZero();
  active_.clear();
  factor_.Clear();
  solution.status = QpStatus::kIterationLimit;
  while (solution.iterations < iteration_limit) {
    int next = NextOfGuess();
    if (next < 0) next = MostViolated();
    if (next < 0) {
      solution.status = QpStatus::kOptimal;
      break;
    }
    ++solution.iterations;
    Enforce(next, solution);
  }
  Refine();
  Report(qp, solution);
  Certify(qp, solution);
  if (solution.status == QpStatus::kOptimal && !(solution.relative_residual <= kProof)) {
    solution.status = QpStatus::kNotProven;
  }
}

}  // namespace oca::qp
