// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/robot_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "oca/diagrams/files/package_paths.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/srdf.h"
#include "oca/models/robot/unseen_links.h"

namespace oca::drafts {
namespace {

namespace fs = std::filesystem;

/// The link at the end of an arm of which all other joints are held: fingers that are, which move
/// in the robot as a `whole`, are none.
int TipOf(const robot::RobotModel& arm, const robot::RobotModel& whole) {
  const auto name = [](const robot::RobotModel& model, int link) {
    return model.links()[static_cast<std::size_t>(link)].name.text();
  };
  const auto last = static_cast<std::size_t>(planning::GuessArm(arm).joints.back());
  const int hand = whole.FindLink(name(arm, arm.joints()[last].child_link));
  return arm.FindLink(name(whole, planning::FarthestFixedTo(whole, hand)));
}

/// The joints that a task of `options` does not move, as numbers, and that have a position.
std::vector<int> JointsBeside(const DraftOptions& options, const robot::RobotModel& whole) {
  if (options.group.empty()) return planning::GuessArm(whole).others;
  const auto group = robot::JointsOfGroup(whole, LoadSrdfOf(options, whole).groups, options.group);
  const std::set<int> within(group.begin(), group.end());
  std::vector<int> beside;
  for (int j = 0; j < whole.num_joints(); ++j) {
    if (whole.joints()[static_cast<std::size_t>(j)].position_index >= 0 && !within.contains(j)) {
      beside.push_back(j);
    }
  }
  return beside;
}

}  // namespace

namespace internal {

fs::path RobotReader::FindPackage(const std::string& package) {
  // A diagram need not name what it finds by itself.
  if (fs::path known = files::KnownPackage(package); !known.empty()) return known;
  fs::path found = files::PackageFor(options_.robot, package);
  if (!found.empty()) packages_[package] = found;
  return found;
}

robot::RobotModel RobotReader::Read(robot::LoadOptions how, bool tell) {
  how.srdf = options_.srdf;
  how.xacro_arguments = options_.arguments;
  how.package_directories = files::PackageFolders();
  how.package_advice = files::kPackageAdvice;
  how.find_package = [this](const std::string& package) { return FindPackage(package); };
  if (tell) how.warn = options_.warn;
  return robot::LoadUrdf(options_.robot, how);
}

void CheckAvoidance(const DraftOptions& options) {
  const std::string begin = "avoidance_", end = ".yaml";
  std::vector<std::string> known;
  const fs::path parts = files::ResolvePath("package://oca/parts", {}, {});
  std::error_code error;
  for (fs::directory_iterator at(parts, error), last; !error && at != last; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (!name.starts_with(begin) || !name.ends_with(end)) continue;
    known.push_back(name.substr(begin.size(), name.size() - begin.size() - end.size()));
  }
  if (std::find(known.begin(), known.end(), options.avoidance) != known.end()) return;
  std::sort(known.begin(), known.end());
  throw ConfigError(fmt::format("avoidance: got '{}'; expected one of: {}", options.avoidance,
                                fmt::join(known, ", ")));
}

void CheckAbsent(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return;
  throw ConfigError(
      fmt::format("{} is there already; expected a name that is not taken", file.string()));
}

}  // namespace internal

robot::Srdf LoadSrdfOf(const DraftOptions& options, const robot::RobotModel& model) {
  if (options.srdf.empty()) return {};
  return robot::LoadSrdf(
      options.srdf, robot::DescribeForSrdf(model.name().text(), model.links(), model.joints()));
}

DraftRobot ReadDraftRobot(const DraftOptions& options) {
  internal::RobotReader reader(options);
  DraftRobot robot;
  robot::LoadOptions how;
  const robot::RobotModel whole = reader.Read(how, true);
  robot.visuals = !robot::DescribeUnseen(whole, "").empty();
  if (robot.visuals) how.visual_as_collision = robot::VisualAsCollision::kMissing;
  how.held.group = options.group;
  for (const int joint : JointsBeside(options, whole)) {
    const robot::Joint& other = whole.joints()[static_cast<std::size_t>(joint)];
    const Eigen::Index at = other.position_index;
    const auto stands = options.stands.find(other.name.text());
    // A group tells by itself what is held, though not where.
    if (!options.group.empty() && stands == options.stands.end()) continue;
    robot.held[other.name.text()] =
        std::clamp(stands == options.stands.end() ? 0.0 : stands->second, whole.lower_limits()[at],
                   whole.upper_limits()[at]);
  }
  how.held.positions = robot.held;
  robot.model = std::make_shared<const robot::RobotModel>(reader.Read(how, false));
  robot.packages = reader.packages();
  robot.tip = TipOf(*robot.model, whole);
  robot.reach = planning::ReachOf(*robot.model, robot.tip);
  return robot;
}

}  // namespace oca::drafts
