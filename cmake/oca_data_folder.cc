// SPDX-License-Identifier: BSD-3-Clause
// Part of every program that links an installed OCA: where that OCA's models, diagrams and page
// are.
#include "oca/diagrams/files/data_folders.h"

namespace {

[[maybe_unused]] const bool kTold = (oca::files::AddDataFolder(OCA_DATA_FOLDER), true);

}  // namespace
