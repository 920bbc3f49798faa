// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

namespace oca::robot {
class RobotModel;
}  // namespace oca::robot

namespace oca::systems {

/// The input by which a system takes the links of another model, `links_right`.
std::string LinksInput(const std::string& model);

/// The robots and frames of a diagram file, by the names that its systems refer to them with.
///
/// A file that another one uses has names of its own: its `arm` may be the `left` of the diagram as
/// a whole. That full name is what records, plans and names of links show. Models of the files
/// around it that it has no name for are called as the nearest of these files calls them.
class ModelSet {
 public:
  using Models = std::map<std::string, std::shared_ptr<const robot::RobotModel>>;

  /// `full_name` empty: as its name. throws ConfigError if the name is taken, or has a dot or slash
  /// in it, which stand between it and names of files and links.
  void Add(const std::string& name, std::shared_ptr<const robot::RobotModel> model,
           const std::string& full_name = "");
  /// The models that a file which uses this one has: part of all(), but not found by Get. In sight
  /// are those that are in sight there and either cannot move or, by their names there, are let in.
  void AddOuter(const ModelSet& outer, const std::function<bool(const std::string&)>& lets_in);
  /// All models of a file that this one uses, by full names; they replace those here.
  void AddInner(const ModelSet& inner);

  /// The model; an empty name means the only one there is, or the only one that moves.
  /// throws ConfigError naming the models there are.
  std::shared_ptr<const robot::RobotModel> Get(const std::string& name) const;
  /// The full name of a model, or of one of the nearest file around this one that has the name; an
  /// empty name means what it means to Get. A name that there is not is itself.
  std::string FullName(const std::string& name) const;
  /// Whether Get knows what an empty name means.
  bool HasOnly() const { return !Only().empty(); }
  /// What stands in one world: by full names.
  const Models& all() const { return all_; }
  /// What systems of this file that look at all others see: names, by full names.
  const std::map<std::string, std::string>& in_sight() const { return in_sight_; }

 private:
  /// The full name of the only model; empty if there is not one.
  std::string Only() const;

  std::map<std::string, std::string> full_names_;   // by name
  std::map<std::string, std::string> outer_names_;  // full ones, by names in the files around this
  std::map<std::string, std::string> in_sight_;
  Models all_;
};

}  // namespace oca::systems
