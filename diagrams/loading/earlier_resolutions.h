// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "oca/diagrams/files/expression.h"

namespace oca::loading {

/// What the expressions of a diagram file, and of those that it uses, came to when it was built
/// last. Any number of threads may use it at once.
class EarlierResolutions {
 public:
  /// Of the file that is used at this path, empty: of the one that is built; null: of none yet.
  std::shared_ptr<const files::Resolution> Of(const std::string& use) const {
    const std::lock_guard lock(mutex_);
    const auto found = last_.find(use);
    return found == last_.end() ? nullptr : found->second;
  }
  void Keep(const std::string& use, files::Resolution resolution) {
    auto kept = std::make_shared<const files::Resolution>(std::move(resolution));
    const std::lock_guard lock(mutex_);
    last_[use].swap(kept);  // the one before goes after the lock does
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const files::Resolution>> last_;
};

}  // namespace oca::loading
