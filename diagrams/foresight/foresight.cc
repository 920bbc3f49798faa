// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/foresight.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "oca/diagrams/foresight/links_ahead.h"
#include "oca/diagrams/foresight/obstacles_ahead.h"
#include "oca/diagrams/foresight/sources_of.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"

namespace oca::foresight {
namespace {

using Eigen::VectorXd;
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

Foresight::Foresight(const Diagram& diagram, const systems::ModelSet& models,
                     const std::string& model, double duration)
    : diagram_(diagram), duration_(duration) {
  const Judges& judge = FindJudge(models, model);
  FindDistances(judge);
  FindMotion(judge);
  AddObstacles();
  if (distances_->own_links) sees_.push_back("own links");
  for (const MeasuresDistances::Other& other : distances_->others) {
    AddOther(other, models.Get(other.model));
  }
  Ignore();
}

const Judges& Foresight::FindJudge(const systems::ModelSet& models, const std::string& model) {
  std::vector<Diagram::Declared<Judges>> judges;
  std::vector<std::string> judged;
  for (const auto& judge : diagram_.FindRoles<Judges>()) {
    const std::string of = FullName(models, judge.role->model);
    if (!model.empty() && of != model) continue;
    judges.push_back(judge);
    judged.push_back(fmt::format("'{}' by {}", of, judge.path));
  }
  if (judges.size() != 1) {
    throw ConfigError(
        fmt::format("judge; got {}; expected {}",
                    judged.empty() ? "none" : fmt::format("{}", fmt::join(judged, ", ")),
                    model.empty() ? "one, or the model that is meant"
                                  : fmt::format("one of the model '{}'", model)));
  }
  name_ = FullName(models, judges[0].role->model);
  judge_ = judges[0].path;
  model_ = models.Get(name_);
  return *judges[0].role;
}

void Foresight::FindDistances(const Judges& judge) {
  auto measured = SourcesOf(diagram_, judge.proximities, [](const System& system) {
    return system.role<MeasuresDistances>() != nullptr;
  });
  if (measured.size() != 1) {
    if (const auto driver = DriverOf(judge.proximities); measured.empty() && driver) {
      measured.push_back(*driver);
    }
    std::vector<std::string> got;
    for (const OutputHandle& one : measured) {
      got.push_back(fmt::format("'{}'", diagram_.PathOf(*one.system)));
    }
    throw ConfigError(fmt::format(
        "{}.proximities: driver; got {}; expected a system that measures distances and says what "
        "there is to see",
        judge_, got.empty() ? "nothing" : fmt::format("{}", fmt::join(got, " and "))));
  }
  distances_ = measured[0].system->role<MeasuresDistances>();
  distance_ = diagram_.PathOf(*measured[0].system);
  if (distances_->model != name_) {
    throw ConfigError(fmt::format("{}.model: got '{}'; expected '{}', which {} judges", distance_,
                                  distances_->model, name_, judge_));
  }
}

std::optional<OutputHandle> Foresight::DriverOf(const InputHandle& input) const {
  return systems::RolePort(input).In(diagram_);
}

void Foresight::FindMotion(const Judges& judge) {
  const auto request = DriverOf(judge.request);
  const auto position = DriverOf(judge.position);
  for (const auto& [port, driver] : {std::pair("request", request), {"position", position}}) {
    if (driver) continue;
    throw ConfigError(fmt::format("{}.{}: driver; got nothing; expected one", judge_, port));
  }
  const std::string where = judge_ + ".request";
  request_ = MotionAheadOf(diagram_, *request, where).motion;
  if (request_->size() != model_->num_positions()) {
    throw ConfigError(fmt::format("{}: length; got {} joints; expected {}", where, request_->size(),
                                  model_->num_positions()));
  }
  const Context context = diagram_.MakeContext();
  const auto start = EvalVector(*position, context);
  start_ = Eigen::Map<const VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
}

void Foresight::AddObstacles() {
  const auto driver = DriverOf(distances_->obstacles);
  if (!driver) return;
  bodies_ =
      BodiesInTime(ObstaclesAhead::Of(diagram_, *driver, distance_ + ".obstacles"), duration_);
  sees_.push_back(diagram_.PathOf(*driver->system));
}

void Foresight::AddOther(const MeasuresDistances::Other& of,
                         const std::shared_ptr<const robot::RobotModel>& other) {
  const std::string& name = of.model;
  if (!Moves(*other)) {
    AddLinks(name, other, {});
    sees_.push_back(name);
    return;
  }
  const auto links = DriverOf(of.links);
  const auto* const kinematics = links ? links->system->role<systems::Kinematics>() : nullptr;
  const auto positions = kinematics != nullptr ? DriverOf(kinematics->position) : std::nullopt;
  const std::string where =
      of.links.system != nullptr ? diagram_.PathOf(of.links) : distance_ + "." + name;
  if (!positions) {
    throw ConfigError(
        fmt::format("{}: driver; got {}; expected the kinematics of a robot", where,
                    links ? fmt::format("'{}'", diagram_.PathOf(*links->system)) : "nothing"));
  }
  const PositionsAhead ahead = PositionsAheadOf(diagram_, *positions, Samples::kBetween, where);
  const std::string source = diagram_.PathOf(*ahead.source);
  AddLinks(name, other, ahead.at);
  sees_.push_back(
      fmt::format("{} {} {}", name, ahead.requested ? "as requested by" : "along", source));
}

void Foresight::AddLinks(const std::string& name,
                         const std::shared_ptr<const robot::RobotModel>& other,
                         Positions positions) {
  const auto links = std::make_shared<LinksAhead>(other, std::move(positions));
  const bool stands = links->Stands(duration_);
  for (const robot::LinkCollider& link : robot::LinkCollidersOf(*other)) {
    const models::Name full_name(name + "/" + link.link.text());
    const std::size_t first = bodies_.size();
    for (planning::BandBody& body : BodiesOf(links, link, full_name, stands)) {
      bodies_.push_back(std::move(body));
    }
    IgnoreLowest(*other, link.number, first);
  }
}

// As the distance block has it: the lowest pair of two arms cannot part.
void Foresight::IgnoreLowest(const robot::RobotModel& other, int other_link,
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

void Foresight::Ignore() {
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

planning::ClairvoyantTask Foresight::Task() const {
  planning::ClairvoyantTask task;
  task.request = [motion = request_](double time, int derivative, Eigen::Ref<VectorXd> out) {
    motion->Evaluate(time, derivative, out);
  };
  task.request_end = request_->times().back();
  task.duration = duration_;
  task.start = start_;
  task.bodies = bodies_;
  task.self_collision = distances_->own_links;
  if (task.self_collision) {
    task.own = robot::OwnRangesAlong(model_, request_.get(), distances_->self_distance);
  }
  task.ignored = ignored_;
  return task;
}

}  // namespace oca::foresight
