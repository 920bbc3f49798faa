// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace oca::verification {

/// tests/verification/README.md: what every integrator reaches on every problem, beside SUNDIALS.
std::string MakePage();

/// tests/verification/work_precision.svg: the named problems, a panel each.
std::string MakeFigure();

}  // namespace oca::verification
