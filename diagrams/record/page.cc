// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/page.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "oca/diagrams/files/data_folders.h"
#include "oca/diagrams/record/message_values.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/file_bytes.h"

namespace oca::record {
namespace {

constexpr std::string_view kPlace = "<!--oca:source-->";

std::vector<std::filesystem::path> Candidates() {
  std::vector<std::filesystem::path> paths;
  if (const char* const named = std::getenv("OCA_VIEWER")) paths.emplace_back(named);
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) {
    const auto folder = program.parent_path();
    paths.push_back(folder / "viewer/viewer.html");
  }
  for (const auto& folder : files::DataFolders()) paths.push_back(folder / "viewer.html");
  return paths;
}

std::string Fill(const std::string& page, const std::string& source) {
  const std::size_t place = page.find(kPlace);
  if (place == std::string::npos) {
    throw ConfigError(
        fmt::format("viewer page: place for the source; got none; expected {}", kPlace));
  }
  std::string filled;
  filled.reserve(page.size() + source.size());
  filled.append(page, 0, place).append(source).append(page, place + kPlace.size());
  return filled;
}

}  // namespace

std::string LoadPage() {
  std::string tried;
  for (const auto& path : Candidates()) {
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) return models::ReadUnnoted(path);
    tried += (tried.empty() ? "" : ", ") + path.string();
  }
  throw ConfigError(
      fmt::format("viewer page: file; got none of {}; expected the page that `npm ci && npm run "
                  "build` in tools/viewer makes (needs Debian's nodejs and npm; tools/setup.sh "
                  "does it), then build again",
                  tried));
}

std::string PageWithRecord(const std::string& page, std::string_view mcap) {
  std::string script = "<script id=\"oca-record\" type=\"application/octet-stream;base64\">";
  script.reserve(script.size() + (mcap.size() + 2) / 3 * 4 + 9);
  AppendBase64(script, mcap);
  return Fill(page, script + "</script>");
}

std::string PageWithSource(const std::string& page, const std::string& source) {
  return Fill(page, "<meta name=\"oca-source\" content=\"" + source + "\">");
}

}  // namespace oca::record
