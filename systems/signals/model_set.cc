// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/model_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::systems {

void ModelSet::Add(const std::string& name, std::shared_ptr<const robot::RobotModel> model) {
  if (!models_.emplace(name, std::move(model)).second) {
    throw ConfigError(fmt::format("models: '{}' is defined twice", name));
  }
}

std::shared_ptr<const robot::RobotModel> ModelSet::Get(const std::string& name) const {
  if (name.empty() && models_.size() == 1) return models_.begin()->second;
  if (const auto found = models_.find(name); found != models_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& entry : models_) names.push_back(entry.first);
  throw ConfigError(fmt::format(
      "model: got '{}'; expected one of: {}{}", name,
      names.empty() ? "(the file has no models)" : fmt::format("{}", fmt::join(names, ", ")),
      DidYouMean(name, names)));
}

}  // namespace oca::systems
