// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "oca/diagrams/files/document.h"
#include "oca/framework/dataflow/log.h"
#include "tools/simulator/commands.h"

namespace oca::tools {

/// `run --live`: runs in step with the clock for whoever looks on, until it is interrupted.
int RunLiveCommand(const RunArguments& arguments, const std::vector<files::Override>& overrides,
                   const files::Catalogue& catalogue, Log* log);

}  // namespace oca::tools
