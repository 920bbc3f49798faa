// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/opened_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "oca/models/error.h"

namespace oca::models {
namespace {

namespace fs = std::filesystem;

thread_local OpenedFiles* innermost = nullptr;

/// Whether a path is one that PlainPath leaves as it is, as most are: saves their parsing.
bool IsPlain(const fs::path& file) {
  const std::string& name = file.native();
  return name.starts_with('/') && name.find("//") == std::string::npos &&
         name.find("/.") == std::string::npos;
}

bool Below(const fs::path& file, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && rest != file.end();
}

}  // namespace

fs::path PlainPath(const fs::path& file) {
  return IsPlain(file) || file.empty() ? file : fs::absolute(file).lexically_normal();
}

bool LiesBelow(const fs::path& file, const fs::path& folder) {
  fs::path root = PlainPath(folder);
  if (!root.has_filename()) root = root.parent_path();  // a/ is a
  if (!Below(PlainPath(file), root)) return false;
  if (std::find(file.begin(), file.end(), "..") == file.end()) return true;
  std::error_code error;  // links before a `..` would lead where the name does not say
  const fs::path real = fs::weakly_canonical(file, error);
  return !error && Below(real, fs::weakly_canonical(root, error)) && !error;
}

OpenedFiles::OpenedFiles(Elder elder)
    : outer_(std::exchange(innermost, this)), apart_(elder == Elder::kNotesNot) {}

OpenedFiles::OpenedFiles(std::vector<fs::path> roots)
    : outer_(std::exchange(innermost, this)), restricted_(true), roots_(std::move(roots)) {}

OpenedFiles::~OpenedFiles() { innermost = outer_; }

bool OpenedFiles::Allows(const fs::path& file) const {
  if (outer_ != nullptr && !outer_->Allows(file)) return false;
  return !restricted_ || std::any_of(roots_.begin(), roots_.end(),
                                     [&](const fs::path& root) { return LiesBelow(file, root); });
}

bool OpenedFiles::Contains(const fs::path& file) const { return Has(PlainPath(file)); }

bool OpenedFiles::Has(const fs::path& plain) const {
  return std::any_of(files_.begin(), files_.end(), [&](const fs::path& file) {
    return file.native() == plain.native();  // as texts: paths compare part by part
  });
}

void NoteOpened(const fs::path& file) {
  if (file.empty()) throw ModelError("got an empty file name; expected a path");
  if (innermost == nullptr) return;
  if (!innermost->Allows(file)) {
    throw ModelError(
        fmt::format("{}: file; got one outside of the record that is run; expected one within it, "
                    "or of a package (package://NAME/PATH)",
                    file.string()));
  }
  const fs::path other = IsPlain(file) ? fs::path() : PlainPath(file);
  const fs::path& plain = other.empty() ? file : other;
  for (OpenedFiles* at = innermost; at != nullptr; at = at->apart_ ? nullptr : at->outer_) {
    if (!at->Has(plain)) at->files_.push_back(plain);
  }
}

}  // namespace oca::models
