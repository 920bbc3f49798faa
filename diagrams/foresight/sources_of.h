// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "oca/framework/dataflow/diagram.h"

namespace oca::foresight {

/// Where the value of an input comes from: outputs of the nearest systems that `counts` accepts, up
/// the line through blocks that pass on, choose or put together values of its type, whether at once
/// or later. None if there is no such input, nothing drives it, or no such system is there.
std::vector<OutputHandle> SourcesOf(const Diagram& diagram, const InputHandle& input,
                                    const std::function<bool(const System&)>& counts);

}  // namespace oca::foresight
