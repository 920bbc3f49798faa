// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/scene_draft.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "oca/diagrams/drafts/draft_text.h"
#include "oca/diagrams/drafts/robot_reader.h"
#include "oca/diagrams/drafts/scene_allowed.h"
#include "oca/diagrams/drafts/scene_draft_text.h"
#include "oca/diagrams/drafts/scene_frames.h"
#include "oca/diagrams/drafts/scene_joints.h"
#include "oca/diagrams/drafts/scene_shapes.h"
#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/error.h"
#include "oca/models/file_cache.h"
#include "oca/models/robot/collision_check.h"
#include "oca/models/scenes/motion_request.h"
#include "oca/models/scenes/planning_scene.h"
#include "oca/models/whole_file.h"

namespace oca::drafts {
namespace {

namespace fs = std::filesystem;
using internal::SceneText;

constexpr double kSceneMotion = 6.0;         // s; of the straight line
constexpr double kSceneAcceleration = 10.0;  // rad/s^2 or m/s^2; where nothing limits it

/// One call of DraftScene.
class SceneDraftMaker {
 public:
  explicit SceneDraftMaker(const SceneDraftOptions& options)
      : options_(options),
        robot_options_(options.draft),
        scene_(scenes::ReadPlanningScene(options.scene)) {
    if (!options.request.empty()) request_ = scenes::ReadMotionRequest(options.request);
    robot_options_.folder = options.diagram.parent_path();
    internal::CheckAvoidance(options.draft);
  }

  SceneDraft Make() {
    internal::CheckAbsent(options_.diagram);
    try {
      Fill();
    } catch (...) {
      for (const fs::path& file : draft_.files) Forget(file);
      if (shapes_) {
        for (const fs::path& file : shapes_->files()) Forget(file);
      }
      throw;
    }
    return std::move(draft_);
  }

 private:
  static void Forget(const fs::path& file) {
    std::error_code ignored;
    fs::remove(file, ignored);
  }
  void Tell(std::string line) { draft_.decided.push_back(std::move(line)); }
  void LeaveOut(std::string line) { draft_.left_out.push_back(std::move(line)); }

  void Fill() {
    draft_.left_out = scene_.notes;
    if (request_) {
      draft_.left_out.insert(draft_.left_out.end(), request_->notes.begin(), request_->notes.end());
    }
    start_joints_ = request_ ? internal::Over(request_->start, scene_.joints) : scene_.joints;
    ReadRobot();
    PlaceBase();
    TakeStart();
    const internal::SceneFrames frames(*model_, start_, worlds_, scene_);
    AddObjects(frames);
    internal::AddAllowed(scene_, *model_, bodies_of_, text_);
    if (!text_.ignored.empty()) {
      Tell(fmt::format("{}: {} allowed collisions became `ignore`", scene_.allowed.where,
                       text_.ignored.size()));
    }
    AddMotion(frames);
    Write();
  }

  void ReadRobot() {
    robot_options_.stands = {start_joints_.positions.begin(), start_joints_.positions.end()};
    if (robot_options_.group.empty() && request_) TakeGroup();
    draft_.robot = ReadDraftRobot(robot_options_);
    const bool allows = !scene_.allowed.pairs.empty() || !scene_.allowed.defaults.empty();
    if (robot_options_.srdf.empty() && !allows) WriteSrdf();
    model_ = draft_.robot.model;
    worlds_ = LoadSrdfOf(robot_options_, *model_).frames;
    for (auto& line : internal::OtherJoints(draft_.robot, start_joints_, "start")) LeaveOut(line);
    if (request_) {
      for (auto& line : internal::OtherJoints(draft_.robot, request_->goal, "goal")) LeaveOut(line);
    }
    if (!scene_.robot.empty() && scene_.robot != model_->name().text()) {
      Tell(fmt::format("{}: the scene is of robot '{}', the model is '{}'", scene_.file,
                       scene_.robot, model_->name().text()));
    }
  }

  void TakeGroup() {
    const std::string& group = request_->group;
    if (group.empty()) return;
    if (robot_options_.srdf.empty()) {
      return Tell(fmt::format("{}: group '{}': no SRDF says what it is; the arm was guessed",
                              request_->file, group));
    }
    internal::RobotReader reader(robot_options_);
    const auto srdf = LoadSrdfOf(robot_options_, reader.Read({}, false));
    std::vector<std::string> names;
    for (const robot::SrdfGroup& known : srdf.groups) names.push_back(known.name);
    if (std::find(names.begin(), names.end(), group) == names.end()) {
      throw models::ModelError(fmt::format("{}: group_name; got '{}'; expected a group of {}{}",
                                           request_->file, group, robot_options_.srdf.string(),
                                           DidYouMean(group, names)));
    }
    robot_options_.group = group;
  }

  /// A robot whose pairs nobody disabled touches itself by design.
  void WriteSrdf() {
    const robot::RobotModel& model = *draft_.robot.model;
    fs::path file = options_.diagram;
    file.replace_extension(".srdf");
    internal::CheckAbsent(file);
    robot::SaveDisabledPairs(file, model.name().text(),
                             robot::PairsToDisable(model, robot::CheckCollisions(model, {})));
    draft_.files.push_back(file);
    robot_options_.srdf = file;
    robot_options_.warn = nullptr;
    draft_.robot = ReadDraftRobot(robot_options_);
    Tell(
        fmt::format("no SRDF and no allowed collisions: pairs of links that may touch were found "
                    "by sampling"));
  }

  void PlaceBase() {
    const auto& bases =
        request_ && !request_->start.bases.empty() ? request_->start.bases : scene_.joints.bases;
    for (const scenes::SceneFrame& base : bases) {
      if (base.X_PF.matrix().isIdentity(0.0)) continue;
      if (text_.base) {
        LeaveOut(fmt::format("{}: '{}': a second joint of the base", base.where, base.name));
        continue;
      }
      text_.base = base.X_PF;
      Tell(fmt::format("{}: joint '{}' places the robot's root", base.where, base.name));
    }
    if (text_.base) {
      model_ = std::make_shared<const robot::RobotModel>(model_->At(*text_.base));
    } else {
      worlds_.push_back(model_->links().front().name.text());
    }
  }

  void TakeStart() {
    if (!start_joints_.positions.empty() || request_) {
      start_ =
          internal::PositionsOf(*model_, start_joints_, request_ ? request_->file : scene_.file,
                                "start_state", &draft_.decided);
      return;
    }
    start_ = internal::NeutralPositions(*model_);
    Tell(fmt::format("{}: no state of the joints: the arm rests at 0, or the limit nearest to it",
                     scene_.file));
  }

  void AddObjects(const internal::SceneFrames& frames) {
    internal::RobotReader reader(robot_options_);
    shapes_.emplace(internal::SceneShapes::Options{
        .diagram = options_.diagram,
        .scene = options_.scene,
        .find_package = [&](const std::string& package) { return reader.FindPackage(package); },
        .told = [this](const std::string& line) { Tell(line); }});
    const auto& X_WL = frames.X_WL();
    const Eigen::Vector3d p_WT = X_WL[static_cast<std::size_t>(draft_.robot.tip)].translation();
    for (const scenes::SceneObject& object : scene_.objects) {
      const Eigen::Isometry3d X_WO = frames.PoseOf(object);
      if (frames.Moves(object.frame.text)) {
        Tell(
            fmt::format("{}: object '{}' is in the frame of '{}', which moves: it stands where "
                        "that is at the start",
                        object.frame.where, object.id, object.frame.text));
      }
      for (auto& body : shapes_->BodiesOf(object, X_WO.inverse() * p_WT)) {
        bodies_of_[object.id].push_back(body.id);
        body.X_OB = X_WO * body.X_OB;
        text_.obstacles.push_back(std::move(body));
      }
    }
    for (const scenes::HeldSceneObject& held : scene_.held) AddHeld(held, frames);
    draft_.obstacles = static_cast<int>(text_.obstacles.size());
    draft_.held = static_cast<int>(text_.held.size());
    draft_.robot.packages.insert(reader.packages().begin(), reader.packages().end());
  }

  void AddHeld(const scenes::HeldSceneObject& held, const internal::SceneFrames& frames) {
    const scenes::SceneObject& object = held.object;
    const int link = LinkOf(held.link, "link_name");
    const Eigen::Isometry3d X_LO =
        frames.X_WL()[static_cast<std::size_t>(link)].inverse() * frames.PoseOf(object);
    for (auto& body : shapes_->BodiesOf(object, Eigen::Vector3d::Zero())) {
      bodies_of_[object.id].push_back(body.id);
      body.X_OB = X_LO * body.X_OB;
      internal::HeldText text{std::move(body), held.link.text, {}};
      for (const scenes::PlacedName& touched : held.touch_links) {
        LinkOf(touched, "touch_links");
        if (touched.text != held.link.text) text.touches.push_back(touched.text);
      }
      // Bodies of one object that touch each other are no collision.
      for (const std::string& earlier : bodies_of_[object.id]) {
        if (earlier != text.body.id) text.touches.push_back(earlier);
      }
      text_.held.push_back(std::move(text));
    }
  }

  int LinkOf(const scenes::PlacedName& name, std::string_view key) const {
    try {
      return model_->FindLink(name.text);
    } catch (const models::ModelError& error) {
      throw models::ModelError(fmt::format("{}: {}: {}", name.where, key, error.what()));
    }
  }

  void AddMotion(const internal::SceneFrames& frames) {
    text_.start = start_;
    if (!request_) return;
    text_.duration = kSceneMotion;
    if (request_->pose) return AddPose(*request_->pose, frames);
    text_.goal = internal::PositionsOf(*model_, request_->goal, request_->file,
                                       "goal_constraints[0]", nullptr);
    const double needed = internal::StraightTime(*model_, start_, *text_.goal, kSceneAcceleration);
    if (needed <= kSceneMotion) return;
    text_.duration = std::ceil(needed);
    Tell(fmt::format("the straight line takes {:g} s, as the limits of the joints want it",
                     text_.duration));
  }

  void AddPose(const scenes::RequestedPose& pose, const internal::SceneFrames& frames) {
    LinkOf(pose.link, "link_name");
    const Eigen::Isometry3d& X_WF = frames.Find(pose.frame);
    Eigen::Isometry3d X_WG = Eigen::Isometry3d::Identity();
    if (pose.rotation) {
      const Eigen::Isometry3d& X_WR = frames.Find(pose.rotation_frame);
      X_WG.linear() = X_WR.linear() * pose.rotation->toRotationMatrix();
    }
    X_WG.translation() = X_WF * pose.position - X_WG.linear() * pose.offset;
    text_.pose = internal::PoseGoalText{pose.link.text, X_WG, !pose.rotation.has_value()};
    Tell(
        fmt::format("{}: goal of a pose: the joints that reach it are found when the diagram is "
                    "loaded; tolerances are not looked at",
                    pose.where));
  }

  void Write() {
    text_.limits_text = internal::LimitsText(*draft_.robot.model);
    if (!text_.limits_text.empty()) {
      fs::path file = options_.diagram;
      file.replace_filename(options_.diagram.stem().string() + "_limits.yaml");
      internal::CheckAbsent(file);
      models::WriteWhole(file, text_.limits_text);
      draft_.files.push_back(file);
      text_.limits = file.filename().string();
      Tell("no limits of speed in the robot's description: " + file.string() + " has guesses");
    }
    text_.intruder = options_.intruder;
    text_.name = options_.diagram.stem().string();
    text_.scene = options_.scene.filename().string();
    text_.request = options_.request.filename().string();
    const std::string text = internal::SceneDiagramText(robot_options_, draft_.robot, text_);
    models::WriteWhole(options_.diagram, text);
    draft_.files.insert(draft_.files.begin(), options_.diagram);
    draft_.files.insert(draft_.files.end(), shapes_->files().begin(), shapes_->files().end());
    RequireThatItLoads();
    if (!model_->acceleration_limits().allFinite()) {
      Tell(
          fmt::format("limits of acceleration: {:g} rad/s^2 or m/s^2, where the robot's "
                      "description has none",
                      kSceneAcceleration));
    }
  }

  /// What only the whole diagram tells: whether the pose can be reached, among others.
  void RequireThatItLoads() const {
    try {
      loading::LoadDiagram(options_.diagram);
    } catch (const Error& error) {
      const std::string where = !request_        ? scene_.file
                                : request_->pose ? request_->pose->where
                                                 : request_->goal.where;
      throw ConfigError(
          fmt::format("{}: makes a diagram that cannot be loaded: {}", where, error.what()));
    }
  }

  const SceneDraftOptions& options_;
  models::FileCache cache_;
  const models::FileCache::Use use_{cache_};
  DraftOptions robot_options_;
  const scenes::PlanningScene scene_;
  std::optional<scenes::MotionRequest> request_;
  scenes::JointPositions start_joints_;
  std::shared_ptr<const robot::RobotModel> model_;
  std::vector<std::string> worlds_;
  Eigen::VectorXd start_;
  std::optional<internal::SceneShapes> shapes_;
  internal::BodiesOfObjects bodies_of_;
  SceneText text_;
  SceneDraft draft_;
};

}  // namespace

void WriteSceneProblem(const fs::path& folder, int number, const robot::RobotModel& model,
                       const scenes::SceneProblem& problem) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw ConfigError(
        fmt::format("{}: {}; expected a folder to write to", folder.string(), error.message()));
  }
  const fs::path scene = folder / fmt::format("scene{:04}.yaml", number);
  const fs::path request = folder / fmt::format("request{:04}.yaml", number);
  internal::CheckAbsent(scene);
  internal::CheckAbsent(request);
  models::WriteWhole(scene, scenes::SceneYaml(model, problem));
  models::WriteWhole(request, scenes::RequestYaml(model, problem));
}

SceneDraft DraftScene(const SceneDraftOptions& options) { return SceneDraftMaker(options).Make(); }

}  // namespace oca::drafts
