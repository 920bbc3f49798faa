// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "diagrams/document.h"
#include "framework/log.h"
#include "tools/commands.h"

namespace oca::tools {

/// `run --live`: runs in step with the clock for whoever looks on, until `interrupted`.
int RunLiveCommand(const RunArguments& arguments, const std::vector<diagrams::Override>& overrides,
                   const diagrams::Catalogue& catalogue, Log* log,
                   const std::function<bool()>& interrupted);

}  // namespace oca::tools
