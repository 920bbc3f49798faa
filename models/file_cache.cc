// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/file_cache.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <new>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/opened_files.h"

namespace oca::models {
namespace {

thread_local FileCache* cache_in_use = nullptr;

template <class Read>
auto WithinMemory(const std::string& file, const Read& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw ModelError(file + ": too large; got no memory for it; expected a smaller file");
  }
}

}  // namespace

struct FileCache::Entry {
  std::mutex reading;
  std::atomic<bool> done{false};
  // From then on constant:
  std::shared_ptr<const void> value;
  std::vector<std::filesystem::path> opened;
};

FileCache::FileCache() = default;
FileCache::~FileCache() = default;

FileCache::Use::Use(FileCache& cache) : outer_(std::exchange(cache_in_use, &cache)) {}
FileCache::Use::~Use() { cache_in_use = outer_; }

std::shared_ptr<FileCache::Entry> FileCache::EntryOf(Keep keep, const std::string& file,
                                                     std::type_index type,
                                                     const std::string& form) {
  const std::lock_guard lock(mutex_);
  Forms& forms = keep == Keep::kAlways ? files_[file].always : files_[file].recent;
  const auto found = std::find_if(forms.begin(), forms.end(), [&](const Form& one) {
    return one.type == type && one.form == form;
  });
  if (found != forms.end()) {
    std::rotate(forms.begin(), found, found + 1);
  } else {
    if (keep == Keep::kRecent && forms.size() == kRecent) forms.pop_back();
    forms.insert(forms.begin(), {type, form, std::make_shared<Entry>()});
  }
  return forms.front().entry;
}

std::shared_ptr<const void> FileCache::Get(Keep keep, const std::string& file, std::type_index type,
                                           const std::string& form, const Read& read) {
  if (cache_in_use == nullptr) return WithinMemory(file, read);
  const std::shared_ptr<Entry> entry = cache_in_use->EntryOf(keep, file, type, form);
  if (!entry->done) {
    const std::lock_guard lock(entry->reading);
    if (!entry->done) {
      const OpenedFiles opened;
      entry->value = WithinMemory(file, read);
      entry->opened = opened.files();
      entry->done = true;
      return entry->value;
    }
  }
  for (const std::filesystem::path& one : entry->opened) NoteOpened(one);
  return entry->value;
}

}  // namespace oca::models
