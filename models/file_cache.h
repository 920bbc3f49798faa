// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <typeindex>
#include <unordered_map>
#include <vector>

namespace oca::models {

/// What was read from files, kept so that each is read once. Its values are immutable and shared;
/// any number of threads may use it at once.
///
///     FileCache cache;
///     FileCache::Use use(cache);  // on this thread, while it lives
///     LoadUrdf("arm.urdf");       // reads the file and its meshes
///     LoadUrdf("arm.urdf");       // finds text and hulls as they were read
///
/// A file goes by the name that it was asked for. What was read of it is kept as long as the cache;
/// of what was made of that with further parameters, a robot with limits or a cloud of balls, the
/// kRecent values that were used last. What fails is not kept.
class FileCache {
 public:
  static constexpr std::size_t kRecent = 16;  ///< a file

  FileCache();
  ~FileCache();
  FileCache(const FileCache&) = delete;
  FileCache& operator=(const FileCache&) = delete;

  /// While it lives, ReadOnce on this thread asks `cache`; of two that live at once the younger one
  /// counts.
  class Use {
   public:
    explicit Use(FileCache& cache);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    FileCache* const outer_;
  };

 private:
  template <class T>
  friend std::shared_ptr<const T> ReadOnce(const std::string& file, const std::string& form,
                                           const std::function<T()>& read);
  template <class T>
  friend std::shared_ptr<const T> MakeOnce(const std::string& file, const std::string& form,
                                           const std::function<T()>& make);
  enum class Keep { kAlways, kRecent };
  using Read = std::function<std::shared_ptr<const void>()>;
  struct Entry;
  struct Form {
    std::type_index type;
    std::string form;
    std::shared_ptr<Entry> entry;
  };
  using Forms = std::vector<Form>;
  struct File {
    Forms always;
    Forms recent;  // those used last come first
  };

  /// From the cache in use; of `read` itself if there is none.
  static std::shared_ptr<const void> Get(Keep keep, const std::string& file, std::type_index type,
                                         const std::string& form, const Read& read);
  std::shared_ptr<Entry> EntryOf(Keep keep, const std::string& file, std::type_index type,
                                 const std::string& form);

  std::mutex mutex_;
  std::unordered_map<std::string, File> files_;
};

/// What `read` reads of a file, which goes by a text of its own, its path as a rule, or read of it
/// before if this thread uses a FileCache. `form` tells it from all else of type T that is read of
/// the file. OpenedFiles hears of the files either way.
/// throws what `read` throws, for the lack of memory a ModelError that names the file
template <class T>
std::shared_ptr<const T> ReadOnce(const std::string& file, const std::string& form,
                                  const std::function<T()>& read) {
  return std::static_pointer_cast<const T>(
      FileCache::Get(FileCache::Keep::kAlways, file, typeid(T), form,
                     [&read] { return std::make_shared<const T>(read()); }));
}

/// The same of what `make` makes of a file and of parameters, which `form` holds all of.
template <class T>
std::shared_ptr<const T> MakeOnce(const std::string& file, const std::string& form,
                                  const std::function<T()>& make) {
  return std::static_pointer_cast<const T>(
      FileCache::Get(FileCache::Keep::kRecent, file, typeid(T), form,
                     [&make] { return std::make_shared<const T>(make()); }));
}

}  // namespace oca::models
