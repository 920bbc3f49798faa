// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// For the source files that write campaigns; not installed.

#include <nlohmann/json_fwd.hpp>

#include "oca/diagrams/sweep/campaign.h"

namespace oca::sweep {

/// What stands in a results file as `campaign`.
nlohmann::ordered_json CampaignTree(const Campaign& campaign);

}  // namespace oca::sweep
