// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "oca/diagrams/files/document.h"
#include "oca/framework/dataflow/log.h"
#include "tools/simulator/commands.h"

namespace oca::tools {

/// `run --live`: runs in step with the clock for whoever looks on, until `interrupted`.
int RunLiveCommand(const RunArguments& arguments, const std::vector<files::Override>& overrides,
                   const files::Catalogue& catalogue, Log* log,
                   const std::function<bool()>& interrupted);

}  // namespace oca::tools
