// SPDX-License-Identifier: BSD-3-Clause
#include "tools/plan_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <set>

#include "framework/dynamic_port.h"
#include "framework/error.h"
#include "framework/port_access.h"
#include "systems/motion_metrics.h"
#include "systems/obstacle_source.h"
#include "systems/request_ahead.h"
#include "systems/robot_kinematics.h"
#include "tools/plan_bodies.h"

namespace oca::tools {
namespace {

using Eigen::VectorXd;

/// Looks around in the wiring of a loaded file.
class Wiring {
 public:
  explicit Wiring(const diagrams::LoadedDiagram& loaded) : loaded_(loaded) {}

  std::string NameOf(const System& system) const {
    for (const Diagram::Child& child : loaded_.diagram->children()) {
      if (child.system.get() == &system) return child.name;
    }
    return "?";
  }
  const diagrams::LoadedDiagram::Block& BlockOf(const System& system) const {
    const std::string name = NameOf(system);
    return *std::find_if(loaded_.systems.begin(), loaded_.systems.end(),
                         [&](const auto& block) { return block.name == name; });
  }
  /// What drives an input; without a system: nothing.
  OutputHandle DriverOf(const InputHandle& input) const {
    for (const auto& [from, to] : loaded_.diagram->connections()) {
      if (to.system == input.system && to.index == input.index) return from;
    }
    return {};
  }
  OutputHandle DriverOf(const System& system, const char* input) const {
    return DriverOf(system.FindInput(input));
  }
  std::vector<const System*> Drivers(const System& system) const {
    std::vector<const System*> drivers;
    for (const auto& [from, to] : loaded_.diagram->connections()) {
      if (to.system == &system) drivers.push_back(from.system);
    }
    return drivers;
  }
  /// Whether nothing up the line has a state.
  bool TimeAlone(const OutputHandle& output) const {
    std::set<const System*> seen;
    std::vector<const System*> open{output.system};
    while (!open.empty()) {
      const System* const system = open.back();
      open.pop_back();
      if (!seen.insert(system).second) continue;
      if (!system->states().empty()) return false;
      for (const System* driver : Drivers(*system)) open.push_back(driver);
    }
    return true;
  }
  /// The motion that the nearest system up the line knows ahead, and which system that is.
  std::pair<std::shared_ptr<const systems::Trajectory>, std::string> AheadOf(
      const OutputHandle& output, const std::string& where) const {
    std::set<const System*> seen;
    std::vector<const System*> level{output.system};
    while (!level.empty()) {
      std::vector<const System*> next;
      std::vector<OutputHandle> found;
      for (const System* const system : level) {
        if (!seen.insert(system).second) continue;
        const auto& outputs = system->outputs();
        for (int i = 0; i < std::ssize(outputs); ++i) {
          if (outputs[i].type == &TypeOf<systems::RequestAhead>()) found.push_back({{system, i}});
        }
        for (const System* driver : Drivers(*system)) next.push_back(driver);
      }
      if (found.size() > 1) {
        throw ConfigError(fmt::format("{}: motion ahead; got both of '{}' and '{}'; expected one",
                                      where, NameOf(*found[0].system), NameOf(*found[1].system)));
      }
      if (found.size() == 1) {
        const Context context = loaded_.diagram->MakeContext();
        auto motion = Output<systems::RequestAhead>{found[0]}.Eval(context).trajectory;
        if (motion) return {std::move(motion), NameOf(*found[0].system)};
      }
      level = std::move(next);
    }
    throw ConfigError(fmt::format(
        "{}: motion ahead; got '{}', up the line from which nobody knows it; expected a source "
        "with the output `ahead`, as a SplineGenerator",
        where, NameOf(*output.system)));
  }

 private:
  const diagrams::LoadedDiagram& loaded_;
};

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
  const Wiring wiring(loaded_);
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
  judge_ = wiring.NameOf(judge);
  model_ = loaded_.models.Get(name_);
  distance_ = wiring.DriverOf(judge, "proximities").system;
  const std::string got = distance_ == nullptr ? "nothing" : wiring.BlockOf(*distance_).type;
  if (got != "BulletDistance") {
    throw ConfigError(
        fmt::format("{}.proximities: driver; got {}; expected a BulletDistance, which says what "
                    "there is to see",
                    judge_, got));
  }
  const auto& block = wiring.BlockOf(*distance_);
  params_ = ReadParams<systems::BulletDistance::Params>(block.params);
  if (FullName(loaded_.models, params_.model) != name_) {
    throw ConfigError(fmt::format("{}.model: got '{}'; expected '{}', which {} judges", block.name,
                                  params_.model, name_, judge_));
  }
  return judge;
}

void PlanScene::FindMotion(const System& judge) {
  const Wiring wiring(loaded_);
  const OutputHandle request = wiring.DriverOf(judge, "request");
  const OutputHandle position = wiring.DriverOf(judge, "position");
  for (const auto& [port, driver] : {std::pair("request", request), {"position", position}}) {
    if (driver.system != nullptr) continue;
    throw ConfigError(fmt::format("{}.{}: driver; got nothing; expected one", judge_, port));
  }
  const std::string where = judge_ + ".request";
  request_ = wiring.AheadOf(request, where).first;
  if (request_->size() != model_->num_positions()) {
    throw ConfigError(fmt::format("{}: length; got {} joints; expected {}", where, request_->size(),
                                  model_->num_positions()));
  }
  const Context context = loaded_.diagram->MakeContext();
  const auto start = EvalVector(position, context);
  start_ = Eigen::Map<const VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
}

void PlanScene::AddObstacles() {
  const Wiring wiring(loaded_);
  const OutputHandle driver = wiring.DriverOf(*distance_, "obstacles");
  const std::string where = wiring.NameOf(*distance_) + ".obstacles";
  const auto& block = wiring.BlockOf(*driver.system);
  if (!wiring.TimeAlone(driver)) {
    throw ConfigError(fmt::format(
        "{}: driver; got '{}', a {}, which depends on the run; expected a source that time alone "
        "moves, as an ObstacleSource",
        where, block.name, block.type));
  }
  std::shared_ptr<ObstacleScript> script;
  if (block.type == "ObstacleSource" &&
      wiring.DriverOf(*driver.system, "offsets").system == nullptr) {
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
  const Wiring wiring(loaded_);
  const std::string port = "links_" + name;
  const std::string where = wiring.NameOf(*distance_) + "." + port;
  const System* const kinematics = wiring.DriverOf(*distance_, port.c_str()).system;
  const auto& block = wiring.BlockOf(*kinematics);
  if (block.type != "RobotKinematics") {
    throw ConfigError(fmt::format("{}: driver; got '{}', a {}; expected a RobotKinematics", where,
                                  block.name, block.type));
  }
  const OutputHandle positions = wiring.DriverOf(*kinematics, "position");
  if (wiring.TimeAlone(positions)) {
    const auto context = std::make_shared<Context>(loaded_.diagram->MakeContext());
    AddLinks(name, other, [context, positions](double time) {
      context->SetTime(time);
      const auto q = EvalVector(positions, *context);
      return VectorXd(Eigen::Map<const VectorXd>(q.data(), static_cast<Eigen::Index>(q.size())));
    });
    sees_.push_back(fmt::format("{} along {}", name, wiring.NameOf(*positions.system)));
    return;
  }
  const auto [motion, source] = wiring.AheadOf(positions, where);
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
