// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

namespace oca::internal {

/// The fastest rate of x' = f(x) near `state`, 1/s: the magnitude of its Jacobian's dominant
/// eigenvalue, roughly. An explicit method whose step times this rate is not well below one is held
/// by stability, not by its tolerance: the system is stiff. 0 if f fails there.
///
/// source power iteration on differences of f, as RKC does: Sommeijer, Shampine, Verwer 1998,
///        J. Comput. Appl. Math. 88, section 3.1
double FastestRate(const std::vector<double>& state,
                   const std::function<bool(const double* x, double* derivative)>& f);

}  // namespace oca::internal
