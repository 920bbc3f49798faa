// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/name.h"

#include <mutex>
#include <unordered_set>

namespace oca::models {
namespace {

const std::string* Intern(std::string_view text) {
  static std::mutex mutex;
  // Never destroyed: names may be read by objects with static storage duration.
  static auto& table = *new std::unordered_set<std::string>;
  const std::lock_guard lock(mutex);
  return &*table.emplace(text).first;
}

}  // namespace

Name::Name() {
  static const std::string* const empty = Intern("");
  text_ = empty;
}

Name::Name(std::string_view text) : text_(Intern(text)) {}

}  // namespace oca::models
