// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/model_set.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/robot/robot_model.h"

namespace oca::systems {

std::string LinksInput(const std::string& model) { return "links_" + model; }

void ModelSet::Add(const std::string& name, std::shared_ptr<const robot::RobotModel> model,
                   const std::string& full_name) {
  if (name.find_first_of("./") != std::string::npos) {
    throw ConfigError(fmt::format("name; got '{}'; expected one without dots and slashes", name));
  }
  const std::string& full = full_name.empty() ? name : full_name;
  if (!full_names_.emplace(name, full).second) {
    throw ConfigError(fmt::format("models: '{}' is defined twice", name));
  }
  in_sight_.emplace(full, name);
  all_.insert_or_assign(full, std::move(model));
}

void ModelSet::AddOuter(const ModelSet& outer,
                        const std::function<bool(const std::string&)>& lets_in) {
  all_.insert(outer.all_.begin(), outer.all_.end());
  outer_names_ = outer.full_names_;
  outer_names_.insert(outer.outer_names_.begin(), outer.outer_names_.end());
  for (const auto& [full, name] : outer.in_sight_) {
    if (outer.all_.at(full)->num_positions() == 0 || lets_in(name)) in_sight_.emplace(full, name);
  }
}

void ModelSet::AddInner(const ModelSet& inner) {
  for (const auto& entry :
       inner.full_names_) {  // its own; what it sees of others stays as it is here
    const std::string& full = entry.second;
    full_names_.emplace(full, full);
    all_.insert_or_assign(full, inner.all_.at(full));
  }
}

std::string ModelSet::Only() const {
  if (full_names_.size() == 1) return full_names_.begin()->second;
  std::string only;
  for (const auto& entry : full_names_) {
    const std::string& full = entry.second;
    if (all_.at(full)->num_positions() == 0) continue;
    if (!only.empty()) return "";
    only = full;
  }
  return only;
}

std::shared_ptr<const robot::RobotModel> ModelSet::Get(const std::string& name) const {
  if (name.empty() && HasOnly()) return all_.at(Only());
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
  if (name.empty() && HasOnly()) return Only();
  for (const auto* const names : {&full_names_, &outer_names_}) {
    if (const auto found = names->find(name); found != names->end()) return found->second;
  }
  return name;
}

}  // namespace oca::systems
