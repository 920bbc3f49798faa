// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/system.h"

namespace oca::systems::internal {

/// An update at one time. Events repeat; that this one does after eleven days changes nothing.
inline Every Once(const Period& at) { return {Period(1000000, 1), at}; }

}  // namespace oca::systems::internal
