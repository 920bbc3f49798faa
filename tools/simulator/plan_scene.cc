// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/plan_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "tools/simulator/motion_ahead.h"
#include "tools/simulator/plan_bodies.h"

namespace oca::tools {
namespace {

using Eigen::VectorXd;
using systems::HoldsObstacles;
using systems::Judges;
using systems::MeasuresDistances;

/// An empty name stands for the only model there is.
std::string FullName(const systems::ModelSet& models, const std::string& name) {
  return name.empty() && models.all().size() == 1 ? models.all().begin()->first : name;
}

bool Moves(const robot::RobotModel& model) { return model.num_positions() > 0; }

int LowestMovable(const robot::RobotModel& model) {
  return model.bodies().empty() ? -1 : model.bodies().front();
}

}  // namespace

PlanScene::PlanScene(const loading::LoadedDiagram& loaded, const std::string& model,
                     double duration)
    : loaded_(loaded), duration_(duration) {
  FindMotion(FindJudge(model));
  AddObstacles();
  if (distances_->own_links) sees_.push_back("own links");
  for (const MeasuresDistances::Other& other : distances_->others) AddOther(other);
  Ignore();
}

const Judges& PlanScene::FindJudge(const std::string& model) {
  const Diagram& diagram = *loaded_.diagram;
  std::vector<Diagram::Declared<Judges>> judges;
  std::vector<std::string> judged;
  for (const auto& judge : diagram.FindRoles<Judges>()) {
    const std::string of = FullName(loaded_.models, judge.role->model);
    if (!model.empty() && of != model) continue;
    judges.push_back(judge);
    judged.push_back(fmt::format("'{}' by {}", of, judge.path));
  }
  if (judges.size() != 1) {
    throw ConfigError(fmt::format(
        "plan: judge; got {}; expected one of {}",
        judged.empty() ? "none" : fmt::format("{}", fmt::join(judged, ", ")),
        model.empty() ? "one model, or --model NAME" : fmt::format("the model '{}'", model)));
  }
  const Judges& judge = *judges[0].role;
  name_ = FullName(loaded_.models, judge.model);
  judge_ = judges[0].path;
  model_ = loaded_.models.Get(name_);
  FindDistances(judge);
  return judge;
}

void PlanScene::FindDistances(const Judges& judge) {
  const Diagram& diagram = *loaded_.diagram;
  const auto proximities = DriverOf(judge.proximities);
  distances_ = proximities ? proximities->system->role<MeasuresDistances>() : nullptr;
  if (distances_ == nullptr) {
    throw ConfigError(fmt::format(
        "{}.proximities: driver; got {}; expected a system that measures distances and says what "
        "there is to see",
        judge_, proximities ? Described(*proximities->system) : "nothing"));
  }
  distance_ = diagram.PathOf(*proximities->system);
  if (distances_->model != name_) {
    throw ConfigError(fmt::format("{}.model: got '{}'; expected '{}', which {} judges", distance_,
                                  distances_->model, name_, judge_));
  }
}

std::optional<OutputHandle> PlanScene::DriverOf(const InputHandle& input) const {
  return systems::RolePort(input).In(*loaded_.diagram);
}

std::string PlanScene::Described(const System& system) const {
  const auto& block = loaded_.BlockOf(system);
  return fmt::format("'{}', a {}", block.name, block.type);
}

void PlanScene::FindMotion(const Judges& judge) {
  const Diagram& diagram = *loaded_.diagram;
  const auto request = DriverOf(judge.request);
  const auto position = DriverOf(judge.position);
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
  const auto driver = DriverOf(distances_->obstacles);
  if (!driver) return;
  const System& source = *driver->system;
  if (!loaded_.diagram->UpstreamOf(*driver, Through::kInstant).of_time_alone()) {
    throw ConfigError(fmt::format(
        "{}.obstacles: driver; got {}, which depends on the run; expected a source that time alone "
        "moves",
        distance_, Described(source)));
  }
  std::shared_ptr<ObstacleScript> script;
  const auto* const holds = source.role<HoldsObstacles>();
  // What it does between its samples counts too, unless it is moved by others.
  if (holds != nullptr && holds->unsampled && !DriverOf(holds->offsets)) {
    const std::shared_ptr<const Diagram> own = MakeDiagramOf(holds->unsampled());
    const auto always = own->FindRoles<HoldsObstacles>();
    script = std::make_shared<ObstacleScript>(own, always.at(0).role->obstacles);
  } else {
    const std::shared_ptr<const Diagram> shared(std::shared_ptr<void>(), loaded_.diagram.get());
    script = std::make_shared<ObstacleScript>(shared, *driver);
  }
  bodies_ = ObstacleScript::Bodies(script, duration_);
  sees_.push_back(loaded_.diagram->PathOf(source));
}

void PlanScene::AddOther(const MeasuresDistances::Other& of) {
  const std::string& name = of.model;
  const auto other = loaded_.models.Get(name);
  if (!Moves(*other)) {
    AddLinks(name, other, [](double) { return VectorXd(0); });
    sees_.push_back(name);
    return;
  }
  const Diagram& diagram = *loaded_.diagram;
  const auto links = DriverOf(of.links);
  const auto* const kinematics = links ? links->system->role<systems::Kinematics>() : nullptr;
  const auto positions = kinematics != nullptr ? DriverOf(kinematics->position) : std::nullopt;
  const std::string where =
      of.links.system != nullptr ? diagram.PathOf(of.links) : distance_ + "." + name;
  if (!positions) {
    throw ConfigError(fmt::format("{}: driver; got {}; expected the kinematics of a robot", where,
                                  links ? Described(*links->system) : "nothing"));
  }
  if (diagram.UpstreamOf(*positions, Through::kInstant).of_time_alone()) {
    const auto context = std::make_shared<Context>(diagram.MakeContext());
    AddLinks(name, other, [context, at = *positions](double time) {
      context->SetTime(time);
      const auto q = EvalVector(at, *context);
      return VectorXd(Eigen::Map<const VectorXd>(q.data(), static_cast<Eigen::Index>(q.size())));
    });
    sees_.push_back(fmt::format("{} along {}", name, diagram.PathOf(*positions->system)));
    return;
  }
  const auto [motion, known_by] = MotionAheadOf(diagram, *positions, where);
  const std::string source = diagram.PathOf(*known_by);
  if (motion->size() != other->num_positions()) {
    throw ConfigError(fmt::format("{}: length of '{}'; got {} joints; expected {}", where, source,
                                  motion->size(), other->num_positions()));
  }
  AddLinks(name, other, [motion = motion](double time) { return motion->Evaluate(time, 0); });
  sees_.push_back(fmt::format("{} as requested by {}", name, source));
}

void PlanScene::AddLinks(const std::string& name,
                         const std::shared_ptr<const robot::RobotModel>& other,
                         std::function<VectorXd(double time)> positions) {
  const auto motion = std::make_shared<OtherMotion>(other, std::move(positions));
  const bool stands = motion->Stands(duration_);
  for (const robot::LinkCollider& link : robot::LinkCollidersOf(*other)) {
    const models::Name full_name(name + "/" + link.link.text());
    const std::size_t first = bodies_.size();
    for (planning::BandBody& body : BodiesOf(motion, link, full_name, stands)) {
      bodies_.push_back(std::move(body));
    }
    IgnoreLowest(*other, link.number, first);
  }
}

// As the distance block has it: the lowest pair of two arms cannot part.
void PlanScene::IgnoreLowest(const robot::RobotModel& other, int other_link,
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
  for (const auto& [own, other] : distances_->ignored) {
    const int link = model_->FindLink(own);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (bodies_[b].name == models::Name(other)) ignored_.emplace_back(link, static_cast<int>(b));
    }
    if (other.starts_with(name_ + "/")) {
      disabled.emplace_back(link, model_->FindLink(other.substr(name_.size() + 1)));
    }
  }
  if (disabled.size() == before) return;
  model_ = std::make_shared<const robot::RobotModel>(
      model_->name(), model_->links(), model_->joints(), model_->X_WB(), std::move(disabled));
}

planning::ClairvoyantTask PlanScene::Task() const {
  planning::ClairvoyantTask task;
  task.request = [motion = request_](double time, int derivative, Eigen::Ref<VectorXd> out) {
    motion->Evaluate(time, derivative, out);
  };
  task.request_end = request_->times().back();
  task.duration = duration_;
  task.start = start_;
  task.bodies = bodies_;
  task.self_collision = distances_->own_links;
  task.ignored = ignored_;
  task.seed = static_cast<std::uint64_t>(loaded_.simulator.seed);
  return task;
}

}  // namespace oca::tools
