// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plan_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "framework/dynamic_port.h"
#include "framework/error.h"
#include "systems/motion_metrics.h"
#include "systems/obstacle_source.h"
#include "systems/robot_kinematics.h"
#include "tools/motion_ahead.h"
#include "tools/plan_bodies.h"

namespace oca::tools {
namespace {

using Eigen::VectorXd;

/// An empty name stands for the only model there is.
std::string FullName(const systems::ModelSet& models, const std::string& name) {
  return name.empty() && models.all().size() == 1 ? models.all().begin()->first : name;
}

bool Moves(const models::RobotModel& model) { return model.num_positions() > 0; }

int LowestMovable(const models::RobotModel& model) {
  return model.bodies().empty() ? -1 : model.bodies().front();
}

}  // namespace

PlanScene::PlanScene(const diagrams::LoadedDiagram& loaded, const std::string& model,
                     double duration)
    : loaded_(loaded), duration_(duration) {
  const System& judge = FindJudge(model);
  FindMotion(judge);
  AddObstacles();
  if (params_.self_collision) sees_.push_back("own links");
  if (params_.calculate_link_forces) {
    for (const std::string& other : params_.others) AddOther(other);
  }
  Ignore();
}

const System& PlanScene::FindJudge(const std::string& model) {
  const Diagram& diagram = *loaded_.diagram;
  std::vector<std::pair<std::string, const System*>> judges;  // model, system
  std::vector<std::string> judged;
  for (const auto& block : loaded_.systems) {
    if (block.type != "MotionMetrics") continue;
    const auto params = ReadParams<systems::MotionMetrics::Params>(block.params);
    const std::string of = FullName(loaded_.models, params.model);
    if (!model.empty() && of != model) continue;
    judges.emplace_back(of, loaded_.diagram->FindSystem(block.name));
    judged.push_back(fmt::format("'{}' by {}", of, block.name));
  }
  if (judges.size() != 1) {
    throw ConfigError(fmt::format(
        "plan: judge; got {}; expected one MotionMetrics of {}",
        judged.empty() ? "none" : fmt::format("{}", fmt::join(judged, ", ")),
        model.empty() ? "one model, or --model NAME" : fmt::format("the model '{}'", model)));
  }
  name_ = judges[0].first;
  const System& judge = *judges[0].second;
  judge_ = diagram.PathOf(judge);
  model_ = loaded_.models.Get(name_);
  const auto proximities = diagram.DriverOf(judge.FindInput("proximities"));
  distance_ = proximities ? proximities->system : nullptr;
  const std::string got = distance_ == nullptr ? "nothing" : loaded_.BlockOf(*distance_).type;
  if (got != "BulletDistance") {
    throw ConfigError(
        fmt::format("{}.proximities: driver; got {}; expected a BulletDistance, which says what "
                    "there is to see",
                    judge_, got));
  }
  const auto& block = loaded_.BlockOf(*distance_);
  params_ = ReadParams<systems::BulletDistance::Params>(block.params);
  if (FullName(loaded_.models, params_.model) != name_) {
    throw ConfigError(fmt::format("{}.model: got '{}'; expected '{}', which {} judges", block.name,
                                  params_.model, name_, judge_));
  }
  return judge;
}

void PlanScene::FindMotion(const System& judge) {
  const Diagram& diagram = *loaded_.diagram;
  const auto request = diagram.DriverOf(judge.FindInput("request"));
  const auto position = diagram.DriverOf(judge.FindInput("position"));
  for (const auto& [port, driver] : {std::pair("request", request), {"position", position}}) {
    if (driver) continue;
    throw ConfigError(fmt::format("{}.{}: driver; got nothing; expected one", judge_, port));
  }
  const std::string where = judge_ + ".request";
  request_ = MotionAheadOf(diagram, *request, where).motion;
  if (request_->size() != model_->num_positions()) {
    throw ConfigError(fmt::format("{}: length; got {} joints; expected {}", where, request_->size(),
                                  model_->num_positions()));
  }
  const Context context = diagram.MakeContext();
  const auto start = EvalVector(*position, context);
  start_ = Eigen::Map<const VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
}

void PlanScene::AddObstacles() {
  const Diagram& diagram = *loaded_.diagram;
  const OutputHandle driver = diagram.DriverOf(distance_->FindInput("obstacles")).value();
  const std::string where = diagram.PathOf(*distance_) + ".obstacles";
  const auto& block = loaded_.BlockOf(*driver.system);
  if (!diagram.UpstreamOf(driver, Through::kInstant).of_time_alone()) {
    throw ConfigError(fmt::format(
        "{}: driver; got '{}', a {}, which depends on the run; expected a source that time alone "
        "moves, as an ObstacleSource",
        where, block.name, block.type));
  }
  std::shared_ptr<ObstacleScript> script;
  if (block.type == "ObstacleSource" && !diagram.DriverOf(driver.system->FindInput("offsets"))) {
    auto params = ReadParams<systems::ObstacleSource::Params>(block.params);
    params.period = Period();  // what it does between its samples counts too
    const std::shared_ptr<const Diagram> own =
        MakeDiagramOf(std::make_unique<systems::ObstacleSource>(params));
    script = std::make_shared<ObstacleScript>(own, own->FindOutput("obstacles"));
  } else {
    const std::shared_ptr<const Diagram> shared(std::shared_ptr<void>(), loaded_.diagram.get());
    script = std::make_shared<ObstacleScript>(shared, driver);
  }
  bodies_ = ObstacleScript::Bodies(script, duration_);
  sees_.push_back(block.name);
}

void PlanScene::AddOther(const std::string& name) {
  const auto other = loaded_.models.Get(name);
  if (!Moves(*other)) {
    AddLinks(name, other, [](double) { return VectorXd(0); });
    sees_.push_back(name);
    return;
  }
  const Diagram& diagram = *loaded_.diagram;
  const std::string port = "links_" + name;
  const std::string where = diagram.PathOf(*distance_) + "." + port;
  const System* const kinematics = diagram.DriverOf(distance_->FindInput(port)).value().system;
  const auto& block = loaded_.BlockOf(*kinematics);
  if (block.type != "RobotKinematics") {
    throw ConfigError(fmt::format("{}: driver; got '{}', a {}; expected a RobotKinematics", where,
                                  block.name, block.type));
  }
  const OutputHandle positions = diagram.DriverOf(kinematics->FindInput("position")).value();
  if (diagram.UpstreamOf(positions, Through::kInstant).of_time_alone()) {
    const auto context = std::make_shared<Context>(loaded_.diagram->MakeContext());
    AddLinks(name, other, [context, positions](double time) {
      context->SetTime(time);
      const auto q = EvalVector(positions, *context);
      return VectorXd(Eigen::Map<const VectorXd>(q.data(), static_cast<Eigen::Index>(q.size())));
    });
    sees_.push_back(fmt::format("{} along {}", name, diagram.PathOf(*positions.system)));
    return;
  }
  const auto [motion, known_by] = MotionAheadOf(diagram, positions, where);
  const std::string source = diagram.PathOf(*known_by);
  if (motion->size() != other->num_positions()) {
    throw ConfigError(fmt::format("{}: length of '{}'; got {} joints; expected {}", where, source,
                                  motion->size(), other->num_positions()));
  }
  AddLinks(name, other, [motion = motion](double time) { return motion->Evaluate(time, 0); });
  sees_.push_back(fmt::format("{} as requested by {}", name, source));
}

void PlanScene::AddLinks(const std::string& name,
                         const std::shared_ptr<const models::RobotModel>& other,
                         std::function<VectorXd(double time)> positions) {
  const auto motion = std::make_shared<OtherMotion>(other, std::move(positions));
  const bool stands = motion->Stands(duration_);
  for (const models::LinkCollider& link : models::LinkCollidersOf(*other)) {
    const models::Name full_name(name + "/" + link.link.text());
    const std::size_t first = bodies_.size();
    for (models::BandBody& body : BodiesOf(motion, link, full_name, stands)) {
      bodies_.push_back(std::move(body));
    }
    IgnoreLowest(*other, link.number, first);
  }
}

// As BulletDistance has it: the lowest pair of two arms cannot part.
void PlanScene::IgnoreLowest(const models::RobotModel& other, int other_link,
                             std::size_t first_body) {
  if (!Moves(other)) return;
  const int body = other.body(other_link);
  if (body >= 0 && body != LowestMovable(other)) return;
  for (int link = 0; link < model_->num_links(); ++link) {
    if (model_->body(link) != LowestMovable(*model_)) continue;
    for (std::size_t b = first_body; b < bodies_.size(); ++b) {
      ignored_.emplace_back(link, static_cast<int>(b));
    }
  }
}

void PlanScene::Ignore() {
  auto disabled = model_->disabled_pairs();
  const std::size_t before = disabled.size();
  for (const auto& pair : params_.ignore) {
    const int link = model_->FindLink(pair[0]);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (bodies_[b].name == models::Name(pair[1]))
        ignored_.emplace_back(link, static_cast<int>(b));
    }
    if (pair[1].starts_with(name_ + "/")) {
      disabled.emplace_back(link, model_->FindLink(pair[1].substr(name_.size() + 1)));
    }
  }
  if (disabled.size() == before) return;
  model_ = std::make_shared<const models::RobotModel>(
      model_->name(), model_->links(), model_->joints(), model_->X_WB(), std::move(disabled));
}

models::ClairvoyantTask PlanScene::Task() const {
  models::ClairvoyantTask task;
  task.request = [motion = request_](double time, int derivative, Eigen::Ref<VectorXd> out) {
    motion->Evaluate(time, derivative, out);
  };
  task.request_end = request_->times().back();
  task.duration = duration_;
  task.start = start_;
  task.bodies = bodies_;
  task.self_collision = params_.self_collision;
  task.ignored = ignored_;
  task.seed = static_cast<std::uint64_t>(loaded_.simulator.seed);
  return task;
}

}  // namespace oca::tools
