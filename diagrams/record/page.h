// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace oca::record {

/// The page that plays records, without a source. Looked up where the environment's OCA_VIEWER
/// says, as `viewer/viewer.html` beside the running program, and as `viewer.html` in the data
/// folders (files::DataFolders).
/// throws ConfigError saying how to build it if there is none.
std::string LoadPage();

/// The page with a record inside: opens offline, on its own.
/// throws ConfigError if `page` has no place for a source.
std::string PageWithRecord(const std::string& page, std::string_view mcap);
/// The page that asks its server for a record (`record.mcap`), or for a run to follow (`live`).
/// throws ConfigError if `page` has no place for a source.
std::string PageWithSource(const std::string& page, const std::string& source);

}  // namespace oca::record
