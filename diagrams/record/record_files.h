// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/record/mcap_reader.h"

namespace oca::record {

/// Everything that a run was made from: `diagram.yaml`, with includes merged and overrides applied
/// but its parameters kept, and every file that the diagram was made from, and no other, as
/// `packages/PACKAGE/...` or `files/...`, where the diagram then looks for it. A diagram file that
/// it uses is `diagram.PATH.yaml`, written in the same way, once for each use. `duration` s of the
/// run, instead of the file's. Beside them the diagram file as it was written, with what it
/// includes, as `sources/...`, and `sources.yaml`, which names it and the overrides: so that other
/// files can be chosen from a record. Of those that a parameter could have chosen instead only the
/// parts that come with OCA are taken. throws ConfigError if a file cannot be read any more.
std::vector<Attachment> FilesOf(const loading::LoadedDiagram& loaded, double duration);

}  // namespace oca::record
