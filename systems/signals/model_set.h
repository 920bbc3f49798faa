// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>
#include <string>

namespace oca::robot {
class RobotModel;
}  // namespace oca::robot

namespace oca::systems {

/// The robots and frames of a diagram file, by the names that its systems refer to them with.
///
/// A file that another one uses has names of its own: its `arm` may be the `left` of the diagram as
/// a whole. That full name is what records, plans and names of links show.
class ModelSet {
 public:
  using Models = std::map<std::string, std::shared_ptr<const robot::RobotModel>>;

  /// `full_name` empty: as its name. throws ConfigError if the name is taken.
  void Add(const std::string& name, std::shared_ptr<const robot::RobotModel> model,
           const std::string& full_name = "");
  /// The models that a file which uses this one sees: part of all(), but not found by name.
  void AddOuter(const ModelSet& outer);
  /// All models of a file that this one uses, by full names; they replace those here.
  void AddInner(const ModelSet& inner);

  /// The model; an empty name means the only one there is.
  /// throws ConfigError naming the models there are.
  std::shared_ptr<const robot::RobotModel> Get(const std::string& name) const;
  /// The full name of a model; an empty name means the only one there is. A name that there is not
  /// is itself.
  std::string FullName(const std::string& name) const;
  /// What stands in one world: by full names.
  const Models& all() const { return all_; }

 private:
  std::map<std::string, std::string> full_names_;  // by name
  Models all_;
};

}  // namespace oca::systems
