// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/scene_draft_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "oca/diagrams/drafts/draft_text.h"
#include "scene_diagram.yaml.in.h"

namespace oca::drafts::internal {
namespace {

constexpr const char* kNoGuess = "\"${acceleration_limit}\"";

/// As a person writes it: in quotes where YAML needs them.
std::string Word(const std::string& text) {
  const bool plain = !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) != 0 &&
                     std::all_of(text.begin(), text.end(), [](unsigned char c) {
                       return c < 128 && (std::isalnum(c) != 0 || c == '_');
                     });
  static const std::vector<std::string> kTaken{"true", "false", "null", "y",  "n",
                                               "yes",  "no",    "on",   "off"};
  std::string lower = text;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool taken = std::find(kTaken.begin(), kTaken.end(), lower) != kTaken.end();
  return plain && !taken ? text : Quoted(text);
}

std::string WordList(const std::vector<std::string>& texts) {
  std::vector<std::string> words;
  for (const std::string& text : texts) words.push_back(Word(text));
  return fmt::format("[{}]", fmt::join(words, ", "));
}

/// An item of a list of bodies; `more`: further keys, each with its line's indent.
std::string BodyItem(const BodyText& body, const std::string& more) {
  const std::string pose = PoseText(body.X_OB);
  if (!body.shape.starts_with('\n') && more.empty()) {
    return fmt::format("      - {{id: {}, shape: {}, pose: {}}}\n", Word(body.id), body.shape,
                       pose);
  }
  return fmt::format("      - id: {}\n{}        pose: {}\n        shape:{}{}\n", Word(body.id),
                     more, pose, body.shape.starts_with('\n') ? "" : " ", body.shape);
}

/// The URDF's own, and where it has none the one of the file.
std::string AccelerationText(const robot::RobotModel& model) {
  const Eigen::VectorXd& limits = model.acceleration_limits();
  std::vector<std::string> texts;
  for (const double limit : limits) {
    texts.push_back(std::isfinite(limit) ? fmt::format("{}", limit) : kNoGuess);
  }
  const bool none =
      std::none_of(limits.begin(), limits.end(), [](double limit) { return std::isfinite(limit); });
  return fmt::format("    acceleration_limits: {}\n",
                     none ? kNoGuess : fmt::format("[{}]", fmt::join(texts, ", ")));
}

std::string ModelsText(const DraftOptions& options, const DraftRobot& robot,
                       const SceneText& scene) {
  const std::string srdf = !options.named_srdf.empty() ? options.named_srdf
                           : options.srdf.empty()      ? ""
                                                       : PathBeside(options.folder, options.srdf);
  std::string text = ModelText(options, robot, srdf, scene.limits);
  text += AccelerationText(*robot.model);
  if (scene.base) text += fmt::format("    base_pose: {}\n", PoseText(*scene.base));
  if (scene.held.empty()) return text;
  text += "    attached:\n";
  for (const HeldText& held : scene.held) {
    std::string more = fmt::format("        link: {}\n", Word(held.link));
    if (!held.touches.empty()) {
      more += fmt::format("        touches: {}\n", WordList(held.touches));
    }
    text += BodyItem(held.body, more);
  }
  return text;
}

std::string ObstaclesText(const SceneText& scene) {
  if (scene.obstacles.empty()) return "";
  std::string text = "    obstacles:\n";
  for (const BodyText& body : scene.obstacles) text += BodyItem(body, "");
  return text;
}

std::string RequestText(const SceneText& scene) {
  std::string text = scene.pose ? "    model: arm\n" : "";
  text +=
      fmt::format("    key_points:\n      - {{time: 0, position: {}}}\n", NumbersText(scene.start));
  if (scene.goal) {
    text += fmt::format("      - {{time: {:g}, position: {}}}\n", scene.duration,
                        NumbersText(*scene.goal));
  }
  if (scene.pose) {
    text += fmt::format(
        "    goal:\n      {}: {}\n      link: {}\n      time: {:g}\n"
        "      clearance: 0.02                       # m; of the posture that is chosen\n",
        scene.pose->turns_freely ? "point" : "pose",
        scene.pose->turns_freely ? NumbersText(scene.pose->X_WG.translation())
                                 : PoseText(scene.pose->X_WG),
        Word(scene.pose->link), scene.duration);
  }
  return text;
}

/// A ball that nobody announced: another one with each seed.
constexpr const char* kIntruderText =
    "sampling:\n"
    "  obstacles:                                # `--seed N` of a run draws it\n"
    "    count: [1, 1]\n"
    "    shapes: [sphere]\n"
    "    extent: [0.2, 0.2]                      # m\n"
    "    approach: {speed: [0.4, 1.6], distance: [0.8, 1.6], start: [0, 4]}\n"
    "  accept: {home_distance: {at_least: 0.005}}   # m\n";

std::string IgnoreText(const SceneText& scene) {
  if (scene.ignored.empty()) return "";
  std::string text = "  distance:\n    ignore:                                 # they may touch\n";
  for (const auto& [link, other] : scene.ignored) {
    text += fmt::format("      - {}\n", WordList({link, other}));
  }
  return text;
}

}  // namespace

std::string SceneDiagramText(const DraftOptions& options, const DraftRobot& robot,
                             const SceneText& scene) {
  const bool moves = scene.goal || scene.pose;
  std::vector<std::string> joints;
  for (const models::Name& joint : robot.model->position_names()) joints.push_back(joint.text());
  return Filled(
      kSceneDiagram,
      {{"sources",
        Quoted(scene.scene) + (scene.request.empty() ? "" : " and " + Quoted(scene.request))},
       {"name", Quoted(scene.name)},
       {"description", moves ? "The arm goes to the goal of a planning scene, straight in its "
                               "joints where it can"
                             : "The arm stands in a planning scene"},
       {"avoidance", options.avoidance},
       {"scale", SmallerDistances(robot.reach)},
       {"intruder", scene.intruder ? kIntruderText : ""},
       {"packages", PackagesText(robot)},
       {"model", ModelsText(options, robot, scene)},
       {"obstacles", ObstaclesText(scene)},
       {"joints", Quoted(fmt::format("the request: {}", fmt::join(joints, ", ")))},
       {"request", RequestText(scene)},
       {"ignore", IgnoreText(scene)},
       {"unit", SplineUnit(*robot.model)},
       {"plant", PlantText(*robot.model, NumbersText(scene.start))},
       {"expect", moves ? ExpectText(*robot.model) : ""}});
}

}  // namespace oca::drafts::internal
