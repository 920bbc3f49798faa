// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/draft_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

#include "first_diagram.yaml.in.h"

namespace oca::drafts::internal {

namespace fs = std::filesystem;

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kSpeedShare = 0.25;   // of the speed limit, on the average
constexpr double kShortest = 4.0;      // s
constexpr double kLongest = 300.0;     // s
constexpr double kForeseen = 25.0;     // s; of a motion that plans of the parts see to its end
constexpr double kPause = 0.5;         // s, before the motion
constexpr double kGuessedSpeed = 1.0;  // rad/s
constexpr double kGuessedSlide = 0.2;  // m/s
constexpr double kUsualReach = 1.0;    // m, of the arms that the distances of parts/ are for

std::string List(const VectorXd& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(fmt::format("{:.4g}", number));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// rad/s or m/s; of a first motion, on the average.
double SpeedOf(const robot::RobotModel& model, Index joint) {
  const double limit = model.velocity_limits()[joint];
  if (std::isfinite(limit)) return kSpeedShare * limit;
  const auto& name = model.position_names()[static_cast<std::size_t>(joint)].text();
  const bool slides = model.joints()[static_cast<std::size_t>(model.FindJoint(name))].type ==
                      robot::JointType::kPrismatic;
  return kSpeedShare * (slides ? kGuessedSlide : kGuessedSpeed);
}

double DurationOf(const planning::FirstMotion& motion, const robot::RobotModel& model) {
  double duration = kShortest;
  for (Index j = 0; j < motion.from.size(); ++j) {
    const double way = std::fabs(motion.to[j] - motion.from[j]);
    if (way > 0.0) duration = std::max(duration, way / SpeedOf(model, j));
  }
  return std::ceil(duration);
}

/// What lets a plan see a motion to its end.
double TimeScaleOf(double duration) { return std::max(1.0, std::ceil(duration / kForeseen)); }

std::string LongerTimes(const std::string& time_scale) {
  if (time_scale == "1") return "";
  return fmt::format("  time_scale: {:<27} # times those of plans; for so long a motion\n",
                     time_scale);
}

}  // namespace

std::string Filled(std::string_view text, const std::map<std::string_view, std::string>& values) {
  std::string filled;
  while (true) {
    const std::size_t open = text.find('@');
    filled += text.substr(0, open);
    if (open == std::string_view::npos) return filled;
    const std::size_t close = text.find('@', open + 1);
    const bool begins_line = filled.empty() || filled.ends_with('\n');
    filled += values.at(text.substr(open + 1, close - open - 1));
    text.remove_prefix(close + 1);
    if (begins_line && text.starts_with('\n')) text.remove_prefix(1);
  }
}

std::string Quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string SmallerDistances(double size) {
  if (size >= kUsualReach) return "";
  return fmt::format(
      "  scale: {:<32.2g} # times the method's distances; as for an arm that reaches so far, m\n",
      size / kUsualReach);
}

Eigen::VectorXd LongestWays(const robot::RobotModel& model) {
  VectorXd ways(model.num_positions());
  for (Index j = 0; j < ways.size(); ++j) ways[j] = kLongest * SpeedOf(model, j);
  return ways;
}

std::string SplineUnit(const robot::RobotModel& model) {
  return model.position_unit() == "m" ? "    unit: m\n" : "";
}

std::string PlantText(const robot::RobotModel& model, const std::string& start) {
  return fmt::format("  plant: {{initial_position: {}{}}}\n", start,
                     model.position_unit() == "m" ? ", unit: m" : "");
}

std::string ExpectText(const robot::RobotModel& model) {
  const std::string unit =
      model.position_unit() == "mixed" ? "rad or m" : std::string(model.position_unit());
  return fmt::format("{:<43}# {}; and no contact, as of every run\n",
                     "expect: {final_error: {at_most: 0.01}}", unit);
}

std::string PackagesText(const DraftRobot& robot) {
  if (robot.packages.empty()) return "";
  std::string text = "packages:\n";
  for (const auto& [name, folder] : robot.packages) {
    text += fmt::format("  {}: {}\n", Quoted(name), Quoted(folder.string()));
  }
  return text;
}

std::string ModelText(const DraftOptions& options, const DraftRobot& robot, const std::string& srdf,
                      const std::string& limits) {
  std::string text = fmt::format(
      "    {}: {}\n", robot::IsXacro(options.robot) ? "xacro" : "urdf",
      Quoted(options.named.empty() ? PathBeside(options.folder, options.robot) : options.named));
  if (!options.arguments.empty()) {
    text += "    arguments:\n";
    for (const auto& [name, value] : options.arguments) {
      text += fmt::format("      {}: {}\n", Quoted(name), Quoted(value));
    }
  }
  if (!srdf.empty()) text += fmt::format("    srdf: {}\n", Quoted(srdf));
  if (!limits.empty()) {
    text += fmt::format("    joint_limits: {}\n", Quoted(limits));
  }
  if (robot.visuals) {
    text +=
        "    visual_as_collision: missing          # it is drawn, but has no collision shapes\n";
  }
  if (!options.group.empty()) text += fmt::format("    group: {}\n", Quoted(options.group));
  if (!robot.held.empty()) {
    text += "    held:                                 # not of the arm: rad or m\n";
    for (const auto& [joint, position] : robot.held) {
      text += fmt::format("      {}: {}\n", Quoted(joint), position);
    }
  }
  return text;
}

std::string PathBeside(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::absolute(folder, error);
  const fs::path path =
      fs::weakly_canonical(file, error).lexically_relative(fs::weakly_canonical(whole, error));
  const bool inside = !path.empty() && *path.begin() != "..";
  return inside ? path.string() : PathFrom(whole, file);
}

std::string PathFrom(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path absolute = fs::weakly_canonical(file, error);
  const fs::path outer = fs::weakly_canonical(folder, error).parent_path();
  const fs::path path = absolute.lexically_relative(outer);
  const bool beside = !path.empty() && *path.begin() != "..";
  return (beside ? ".." / path : absolute).string();
}

std::string PlainName(const std::string& robot) {
  std::string name;
  for (const char letter : robot) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_' || letter == '-';
    name += plain ? letter : '_';
  }
  return name.empty() ? "robot" : name.substr(0, 60);
}

MotionText TextOf(const planning::FirstMotion& motion, const DraftRobot& robot) {
  const double duration = DurationOf(motion, *robot.model);
  const auto point = [](double time, const VectorXd& position) {
    return fmt::format("{{time: {:g}, position: {}}}", time, List(position));
  };
  return {point(kPause, motion.from),
          point(kPause + duration, motion.to),
          fmt::format("{{id: ball, shape: {{type: sphere, radius: {:.3g}}}, pose: {{xyz: {}}}}}",
                      motion.radius, List(motion.ball)),
          List(motion.from),
          fmt::format("{:g}", kPause + 2.0 * duration),
          SmallerDistances(motion.size),
          fmt::format("{:g}", TimeScaleOf(duration))};
}

std::vector<files::Override> OverridesOf(const MotionText& motion, const std::string& made_for) {
  const auto change = [&](const char* path, std::string value) {
    return files::Override{path, std::move(value), {}, made_for};
  };
  return {change("systems.spline.key_points", fmt::format("[{}, {}]", motion.first, motion.second)),
          change("systems.obstacles.obstacles", fmt::format("[{}]", motion.ball)),
          change("systems.plant.initial_position", motion.start),
          change("simulator.duration", motion.duration),
          change("parameters.time_scale", motion.time_scale)};
}

std::string DiagramText(const DraftOptions& options, const DraftRobot& robot,
                        const MotionText& motion, const std::string& srdf,
                        const std::string& limits) {
  const std::string name = PlainName(robot.model->name().text());
  std::vector<std::string> joints;
  for (const models::Name& joint : robot.model->position_names()) joints.push_back(joint.text());
  return Filled(kFirstDiagram, {{"name", Quoted(name)},
                                {"avoidance", options.avoidance},
                                {"scale", motion.scale + LongerTimes(motion.time_scale)},
                                {"duration", motion.duration},
                                {"packages", PackagesText(robot)},
                                {"model", ModelText(options, robot, srdf, limits)},
                                {"ball", motion.ball},
                                {"joints", Quoted(fmt::format("{}", fmt::join(joints, ", ")))},
                                {"first", motion.first},
                                {"second", motion.second},
                                {"unit", SplineUnit(*robot.model)},
                                {"plant", PlantText(*robot.model, motion.start)},
                                {"expect", ExpectText(*robot.model)}});
}

std::string LimitsText(const robot::RobotModel& model) {
  std::string text;
  for (const robot::Joint& joint : model.joints()) {
    if (joint.position_index < 0) continue;
    if (std::isfinite(model.velocity_limits()[joint.position_index])) continue;
    const bool slides = joint.type == robot::JointType::kPrismatic;
    text += fmt::format(
        "  {}: {{has_velocity_limits: true, max_velocity: {:g}}}   # {}; a guess: the description "
        "has none\n",
        Quoted(joint.name.text()), slides ? kGuessedSlide : kGuessedSpeed,
        slides ? "m/s" : "rad/s");
  }
  return text.empty() ? "" : "# In MoveIt's format.\njoint_limits:\n" + text;
}

}  // namespace oca::drafts::internal
