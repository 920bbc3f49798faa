// SPDX-License-Identifier: BSD-3-Clause
// What urdf_outline.h says of the tree of links: whether it is one, and its order.
#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "oca/models/error.h"
#include "oca/models/nearest_name.h"
#include "oca/models/robot/urdf_outline.h"

namespace oca::robot {
namespace {

using Index = std::unordered_map<std::string, std::size_t>;

template <typename Entry>
Index IndexByName(const std::vector<Entry>& entries) {
  Index index;
  for (const Entry& entry : entries) index.emplace(entry.name, index.size());
  return index;
}

std::string Nearest(const std::string& name, const Index& index) {
  std::vector<std::string> names;
  for (const auto& entry : index) names.push_back(entry.first);
  return models::NearestName(name, names);
}

class TreeChecker {
 public:
  TreeChecker(const UrdfOutline& outline, const std::string& where, models::ModelErrors& errors)
      : outline_(outline),
        where_(where),
        errors_(errors),
        links_(IndexByName(outline.links)),
        joints_(IndexByName(outline.joints)) {}

  void Check() const {
    // Follow each link's parent joint; -1 marks a root.
    std::vector<int> parent_joint(outline_.links.size(), -1);
    for (std::size_t j = 0; j < outline_.joints.size(); ++j) {
      errors_.Try([&] { Attach(j, parent_joint); });
    }
    if (errors_.empty()) {  // else every link that a wrong joint would carry is a root
      errors_.Try([&] { CheckRoots(parent_joint); });
      errors_.Try([&] { CheckLoops(parent_joint); });
    }
    for (const UrdfOutline::Joint& joint : outline_.joints) {
      errors_.Try([&] { CheckMimic(joint); });
    }
  }

 private:
  void Attach(std::size_t index, std::vector<int>& parent_joint) const {
    const UrdfOutline::Joint& joint = outline_.joints[index];
    FindLink(joint, joint.parent, "parent");
    int& parent = parent_joint[FindLink(joint, joint.child, "child")];
    if (parent >= 0) {
      Fail(joint, fmt::format("child link '{}'", joint.child),
           fmt::format("a loop: joint '{}' leads there too", outline_.joints[parent].name),
           "one parent a link");
    }
    parent = static_cast<int>(index);
  }

  [[noreturn]] void Fail(const UrdfOutline::Joint& joint, const std::string& what,
                         const std::string& got, const std::string& expected) const {
    throw models::ModelError(fmt::format("{}:{}: joint '{}': {}; got {}; expected {}", where_,
                                         joint.line, joint.name, what, got, expected));
  }

  std::size_t FindLink(const UrdfOutline::Joint& joint, const std::string& name,
                       const char* role) const {
    const auto found = links_.find(name);
    if (found == links_.end()) {
      Fail(joint, fmt::format("unknown {} link", role), fmt::format("'{}'", name),
           fmt::format("a link of the file, nearest is '{}'", Nearest(name, links_)));
    }
    return found->second;
  }

  void CheckRoots(const std::vector<int>& parent_joint) const {
    const UrdfOutline::Link* root = nullptr;
    for (std::size_t i = 0; i < parent_joint.size(); ++i) {
      if (parent_joint[i] >= 0) continue;
      const UrdfOutline::Link& link = outline_.links[i];
      if (root != nullptr) {
        throw models::ModelError(fmt::format(
            "{}:{}: root link; got two, '{}' and '{}'; expected one link without parent", where_,
            link.line, root->name, link.name));
      }
      root = &link;
    }
  }

  // Walks up from each link until a root or a link known to reach one.
  void CheckLoops(const std::vector<int>& parent_joint) const {
    std::vector<bool> rooted(parent_joint.size(), false);
    for (std::size_t start = 0; start < parent_joint.size(); ++start) {
      std::vector<std::size_t> path;
      for (std::size_t at = start; !rooted[at];) {
        path.push_back(at);
        if (parent_joint[at] < 0) break;
        const UrdfOutline::Joint& joint = outline_.joints[parent_joint[at]];
        if (path.size() > parent_joint.size()) {
          Fail(joint, "tree", "a loop of joints", "a path from each link to the root");
        }
        at = links_.at(joint.parent);
      }
      for (const std::size_t link : path) rooted[link] = true;
    }
  }

  void CheckMimic(const UrdfOutline::Joint& joint) const {
    if (joint.fixed) return;  // whatever it mimics, it stays where it is
    std::size_t hops = 0;
    for (const UrdfOutline::Joint* at = &joint; !at->mimic.empty(); ++hops) {
      const auto found = joints_.find(at->mimic);
      if (found == joints_.end()) {
        Fail(*at, "mimic of an unknown joint", fmt::format("'{}'", at->mimic),
             fmt::format("a joint of the file, nearest is '{}'", Nearest(at->mimic, joints_)));
      }
      if (hops > outline_.joints.size()) {
        Fail(joint, "mimic", "a loop of mimic rules", "a joint that mimics none at the end");
      }
      at = &outline_.joints[found->second];
      if (at->fixed) {
        Fail(joint, "mimic", fmt::format("'{}', a fixed joint", at->name), "a joint that moves");
      }
    }
  }

  const UrdfOutline& outline_;
  const std::string& where_;
  models::ModelErrors& errors_;
  Index links_, joints_;
};

}  // namespace

void CheckUrdfTree(const UrdfOutline& outline, const std::string& where,
                   models::ModelErrors& errors) {
  TreeChecker(outline, where, errors).Check();
}

UrdfOrder OrderUrdf(const UrdfOutline& outline) {
  const Index link_of_name = IndexByName(outline.links);
  std::vector<std::vector<std::size_t>> joints_below(outline.links.size());
  std::vector<bool> root(outline.links.size(), true);
  for (std::size_t j = 0; j < outline.joints.size(); ++j) {
    joints_below[link_of_name.at(outline.joints[j].parent)].push_back(j);
    root[link_of_name.at(outline.joints[j].child)] = false;
  }
  UrdfOrder order;
  std::vector<std::size_t> pending;  // joints, without recursion
  const auto visit = [&](std::size_t link) {
    order.number_of_link[outline.links[link].name] = static_cast<int>(order.links.size());
    order.links.push_back(link);
    pending.insert(pending.end(), joints_below[link].rbegin(), joints_below[link].rend());
  };
  visit(static_cast<std::size_t>(std::find(root.begin(), root.end(), true) - root.begin()));
  while (!pending.empty()) {
    const std::size_t joint = pending.back();
    pending.pop_back();
    order.number_of_joint[outline.joints[joint].name] = static_cast<int>(order.joints.size());
    order.joints.push_back(joint);
    visit(link_of_name.at(outline.joints[joint].child));
  }
  return order;
}

}  // namespace oca::robot
