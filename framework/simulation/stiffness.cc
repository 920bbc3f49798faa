// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/stiffness.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace oca::internal {
namespace {

double Norm(const std::vector<double>& x) {
  double squares = 0.0;
  for (const double value : x) squares += value * value;
  return std::sqrt(squares);
}

}  // namespace

double FastestRate(const std::vector<double>& state,
                   const std::function<bool(const double* x, double* derivative)>& f) {
  constexpr int kIterations = 20;
  std::vector<double> slope(state.size()), moved(state.size()), direction(state.size());
  if (!f(state.data(), slope.data())) return 0.0;
  // No component of the first direction is zero: it must not miss the fastest one.
  const double typical = std::max(Norm(slope), 1.0) / std::sqrt(static_cast<double>(state.size()));
  for (std::size_t i = 0; i < state.size(); ++i) {
    direction[i] = slope[i] + (i % 2 == 0 ? typical : -0.5 * typical);
  }
  const double reach =
      std::sqrt(std::numeric_limits<double>::epsilon()) * std::max(Norm(state), 1e-3);
  double rate = 0.0;
  for (int i = 0; i < kIterations; ++i) {
    const double scale = reach / Norm(direction);
    if (!std::isfinite(scale)) return rate;  // f does not change in that direction
    for (std::size_t k = 0; k < state.size(); ++k) moved[k] = state[k] + scale * direction[k];
    if (!f(moved.data(), direction.data())) return 0.0;
    for (std::size_t k = 0; k < state.size(); ++k) direction[k] -= slope[k];
    rate = Norm(direction) / reach;
  }
  return rate;
}

}  // namespace oca::internal
