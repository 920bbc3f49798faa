// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/draft_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>

namespace oca::drafts::internal {

namespace fs = std::filesystem;

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kSpeedShare = 0.25;   // of the speed limit, on the average
constexpr double kShortest = 4.0;      // s
constexpr double kPause = 0.5;         // s, before the motion
constexpr double kGuessedSpeed = 1.0;  // rad/s
constexpr double kGuessedSlide = 0.2;  // m/s
constexpr double kUsualReach = 1.0;    // m, of the arms that the distances of parts/ are for

std::string List(const VectorXd& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(fmt::format("{:.4g}", number));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

double DurationOf(const planning::FirstMotion& motion, const robot::RobotModel& model) {
  double duration = kShortest;
  for (Index j = 0; j < motion.from.size(); ++j) {
    const double way = std::fabs(motion.to[j] - motion.from[j]);
    if (way == 0.0) continue;
    double speed = model.velocity_limits()[j];
    if (!std::isfinite(speed)) speed = model.position_unit() == "m" ? kGuessedSlide : kGuessedSpeed;
    duration = std::max(duration, way / (kSpeedShare * speed));
  }
  return std::ceil(duration);
}

}  // namespace

std::string Quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string SmallerDistances(double reach) {
  if (reach >= kUsualReach) return "";
  return fmt::format("  scale: {:<32.2g} # times the method's distances; the arm's reach, m\n",
                     reach / kUsualReach);
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
  return {point(kPause, motion.from), point(kPause + duration, motion.to),
          fmt::format("{{id: ball, shape: {{type: sphere, radius: {:.3g}}}, pose: {{xyz: {}}}}}",
                      motion.radius, List(motion.ball)),
          List(motion.from), fmt::format("{:g}", kPause + 2.0 * duration)};
}

std::vector<files::Override> OverridesOf(const MotionText& motion) {
  return {{"systems.spline.key_points", fmt::format("[{}, {}]", motion.first, motion.second)},
          {"systems.obstacles.obstacles", fmt::format("[{}]", motion.ball)},
          {"systems.plant.initial_position", motion.start},
          {"simulator.duration", motion.duration}};
}

std::string DiagramText(const DraftOptions& options, const DraftRobot& robot,
                        const MotionText& motion, const std::string& srdf,
                        const std::string& limits) {
  const std::string name = PlainName(robot.model->name().text());
  std::vector<std::string> joints;
  for (const models::Name& joint : robot.model->position_names()) joints.push_back(joint.text());
  std::string text = fmt::format(
      "# A first diagram, by `simulator new`. Next: key points and obstacles of your own.\n"
      "name: {}\n"
      "description: The arm turns past a ball that lies across its way\n"
      "include: [package://oca/parts/avoidance.yaml]   # the loop: distances, method, limits, "
      "plant\n"
      "parameters:\n"
      "  avoidance: {}\n"
      "  self_collision: true\n"
      "  acceleration_limit: 10.0                # rad/s^2 or m/s^2; a guess: URDF has none\n{}"
      "simulator: {{duration: {}}}                 # s; twice what the motion is asked to take\n",
      Quoted(name), options.avoidance, SmallerDistances(robot.reach), motion.duration);
  text += PackagesText(robot);
  text += "models:\n  arm:\n" + ModelText(options, robot, srdf, limits);
  text += fmt::format(
      "systems:\n"
      "  obstacles:\n"
      "    type: ObstacleSource\n"
      "    obstacles:\n"
      "      - {}\n"
      "  spline:                                   # the request: {}\n"
      "    type: SplineGenerator\n"
      "    period: ${{1 / rate}}\n{}"
      "    key_points:\n"
      "      - {}\n"
      "      - {}\n",
      motion.ball, Quoted(fmt::format("{}", fmt::join(joints, ", "))), SplineUnit(*robot.model),
      motion.first, motion.second);
  text += PlantText(*robot.model, motion.start);
  text += ExpectText(*robot.model);
  return text;
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
