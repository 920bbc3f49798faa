// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/files/document.h"
#include "oca/framework/dataflow/log.h"
#include "tools/simulator/commands.h"

namespace CLI {
class App;
}

namespace oca::tools {

/// Adds the options of where a record is served.
void AddServerOptions(CLI::App& command, ViewArguments& arguments);

/// Serves the page on a record, which is `what`, until it is interrupted; of `arguments` it needs
/// no file.
int ServeRecord(const std::string& what, std::string record, const ViewArguments& arguments);

/// `run --live`: runs in step with the clock for whoever looks on, until it is interrupted.
int RunLiveCommand(const RunArguments& arguments, const std::vector<files::Override>& overrides,
                   const files::Catalogue& catalogue, Log* log);

}  // namespace oca::tools
