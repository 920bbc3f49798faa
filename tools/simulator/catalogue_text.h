// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/model_set.h"

namespace oca::tools {

/// What a port carries, as `simulator describe` and the page of the systems say it: its type, and
/// of a vector the unit; `u` is a unit that Build settles.
std::string PortText(const System::InputInfo& port);
std::string PortText(const System::OutputInfo& port);

/// The robots that CatalogueRow::MakeExample needs.
systems::ModelSet ExampleModels();

}  // namespace oca::tools
