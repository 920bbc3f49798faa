// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace oca::sweep {

struct ConfidenceInterval {
  double low;
  double high;
};

/// A share of samples and where that of the whole population lies with 95 % confidence.
///
///     (p + z^2/2n -+ z sqrt(p (1 - p)/n + z^2/4n^2)) / (1 + z^2/n),   z = 1.96
///
/// [0, 1] of no samples.
/// source Wilson, Probable inference, J. Am. Stat. Assoc. 22, 1927
ConfidenceInterval WilsonInterval(std::size_t count, std::size_t of);

/// The value that a share `q` of the sorted values, which are not none, does not exceed; between
/// two of them it is interpolated linearly.
double Quantile(const std::vector<double>& sorted, double q);

/// Where the median of the population lies with at least 95 % confidence, whatever its
/// distribution: from the k-th least to the k-th largest value, with the largest k for which
/// P(Binomial(n, 1/2) < k) <= 0.025; all values if there are fewer than 6. Not of none.
/// source Conover, Practical Nonparametric Statistics, 3rd ed., section 3.2
ConfidenceInterval MedianInterval(const std::vector<double>& sorted);

}  // namespace oca::sweep
