// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/model_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::systems {

void ModelSet::Add(const std::string& name, std::shared_ptr<const robot::RobotModel> model,
                   const std::string& full_name) {
  const std::string& full = full_name.empty() ? name : full_name;
  if (!full_names_.emplace(name, full).second) {
    throw ConfigError(fmt::format("models: '{}' is defined twice", name));
  }
  all_.insert_or_assign(full, std::move(model));
}

void ModelSet::AddOuter(const ModelSet& outer) {
  all_.insert(outer.all_.begin(), outer.all_.end());
}

void ModelSet::AddInner(const ModelSet& inner) {
  for (const auto& entry :
       inner.full_names_) {  // its own; what it sees of others stays as it is here
    const std::string& full = entry.second;
    full_names_.emplace(full, full);
    all_.insert_or_assign(full, inner.all_.at(full));
  }
}

std::shared_ptr<const robot::RobotModel> ModelSet::Get(const std::string& name) const {
  if (name.empty() && full_names_.size() == 1) return all_.at(full_names_.begin()->second);
  if (const auto found = full_names_.find(name); found != full_names_.end()) {
    return all_.at(found->second);
  }
  std::vector<std::string> names;
  for (const auto& entry : full_names_) names.push_back(entry.first);
  throw ConfigError(fmt::format(
      "model: got '{}'; expected one of: {}{}", name,
      names.empty() ? "(the file has no models)" : fmt::format("{}", fmt::join(names, ", ")),
      DidYouMean(name, names)));
}

std::string ModelSet::FullName(const std::string& name) const {
  if (name.empty() && full_names_.size() == 1) return full_names_.begin()->second;
  const auto found = full_names_.find(name);
  return found == full_names_.end() ? name : found->second;
}

}  // namespace oca::systems
