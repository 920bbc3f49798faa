// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/statistics.h"

#include <algorithm>
#include <cmath>

namespace oca::sweep {

ConfidenceInterval WilsonInterval(std::size_t count, std::size_t of) {
  if (of == 0) return {0.0, 1.0};
  constexpr double z = 1.959963984540054;
  const auto n = static_cast<double>(of);
  const double p = static_cast<double>(count) / n;
  const double middle = p + z * z / (2.0 * n);
  const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  const double scale = 1.0 + z * z / n;
  // At no and at all samples the ends are exact; rounding must not move them.
  return {count == 0 ? 0.0 : (middle - half) / scale, count == of ? 1.0 : (middle + half) / scale};
}

double Quantile(const std::vector<double>& sorted, double q) {
  const double place = q * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

ConfidenceInterval MedianInterval(const std::vector<double>& sorted) {
  const auto n = static_cast<double>(sorted.size());
  std::size_t k = 0;
  double below = 0.0;  // P(Binomial(n, 1/2) <= k)
  for (; k < sorted.size() / 2; ++k) {
    const auto i = static_cast<double>(k);
    below += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) -
                      n * std::log(2.0));
    if (below > 0.025) break;
  }
  if (k == 0) return {sorted.front(), sorted.back()};
  return {sorted[k - 1], sorted[sorted.size() - k]};
}

}  // namespace oca::sweep
