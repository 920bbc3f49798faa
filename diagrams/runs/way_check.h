// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "oca/diagrams/foresight/foresight.h"

namespace oca::runs {

/// What is to be told if no way was found from the start to the end of a request, nor to where the
/// limits of the joints end it, past what stands from the beginning to the end, and own links if
/// they count: how far a bounded search came, and what is near there. Nothing if a way was found,
/// if either end is in contact, which is another thing to tell, or if nothing stands.
///
/// A way that was found is proved clear, that none was found proves nothing.
std::optional<std::string> NoWayText(const foresight::Foresight& scene);

}  // namespace oca::runs
