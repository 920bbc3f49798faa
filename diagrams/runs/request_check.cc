// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/request_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

#include "oca/diagrams/foresight/foresight.h"
#include "oca/diagrams/foresight/motion_ahead.h"
#include "oca/diagrams/runs/way_check.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/counted.h"
#include "oca/models/error.h"
#include "oca/models/planning/arm_guess.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/systems/signals/roles.h"

namespace oca::runs {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kRequestSamples = 1000;
constexpr double kTurnApart = 1e-3;      // rad; of start and request
constexpr double kSlideApart = 1e-3;     // m
constexpr double kLimitRounding = 1e-9;  // of a limit: what digits of a file take from it

/// What is asked of one robot.
class RequestJudge {
 public:
  RequestJudge(const loading::LoadedDiagram& loaded, const systems::Judges& judge)
      : loaded_(loaded),
        name_(loaded.models.FullName(judge.model)),
        model_(*loaded.models.all().at(name_)) {
    const Diagram& diagram = *loaded.diagram;
    const auto request = systems::RolePort(judge.request).In(diagram);
    const auto position = systems::RolePort(judge.position).In(diagram);
    if (!request || !position) return;
    try {
      ahead_ = foresight::MotionAheadOf(diagram, *request, "request");
    } catch (const ConfigError&) {
      return;  // it is made as the run goes
    }
    if (ahead_->motion->size() != model_.num_positions()) {
      ahead_.reset();
      return;
    }
    const Context context = diagram.MakeContext();
    const auto start = EvalVector(*position, context);
    start_ = Eigen::Map<const VectorXd>(start.data(), static_cast<Index>(start.size()));
    at_start_ = position->system;
    at_start_port_ = *position;
  }

  std::vector<std::string> Run() {
    if (!ahead_) return {};
    JudgeStart();
    JudgeEnds();
    JudgeBeside();
    const auto& speed = model_.velocity_limits();
    const auto& acceleration = model_.acceleration_limits();
    JudgeRequest({0, "go to", "", "no method goes there"}, model_.lower_limits(),
                 model_.upper_limits());
    JudgeRequest({1, "move at", "/s", "it comes late"}, -speed, speed);
    JudgeRequest({2, "accelerate with", "/s^2", "it comes late"}, -acceleration, acceleration);
    JudgeContacts();
    return std::move(lines_);
  }

 private:
  void Add(const System& system, const std::string& what) {
    const auto& block = loaded_.BlockOf(system);
    lines_.push_back(Diagnostic{block.params.location(),
                                loading::OverridePath(block.name) + ": " + what,
                                Diagnostic::Kind::kWarning}
                         .ToString());
  }

  std::string JointText(Index joint) const {
    return fmt::format("joint '{}'",
                       model_.position_names()[static_cast<std::size_t>(joint)].text());
  }
  const char* UnitOf(Index joint) const {
    const auto& of = model_.joints()[static_cast<std::size_t>(
        model_.FindJoint(model_.position_names()[static_cast<std::size_t>(joint)].text()))];
    return robot::PositionUnit(of);
  }

  void JudgeStart() {
    for (Index j = 0; j < std::min(start_.size(), Index{model_.num_positions()}); ++j) {
      const double lower = model_.lower_limits()[j];
      const double upper = model_.upper_limits()[j];
      if (start_[j] >= lower - kLimitRounding && start_[j] <= upper + kLimitRounding) continue;
      Add(*at_start_, fmt::format("{} starts at {:.4g} {}; its limits are [{:.4g}, {:.4g}]",
                                  JointText(j), start_[j], UnitOf(j), lower, upper));
    }
  }

  /// A request that begins elsewhere is a jump; of one that ends after the run the end is missing.
  void JudgeEnds() {
    const VectorXd begin = ahead_->motion->Evaluate(0.0, 0);
    std::vector<Index> apart;
    for (Index j = 0; start_.size() == begin.size() && j < begin.size(); ++j) {
      const bool slides = std::string_view(UnitOf(j)) == "m";
      if (std::fabs(begin[j] - start_[j]) > (slides ? kSlideApart : kTurnApart)) apart.push_back(j);
    }
    if (!apart.empty()) {
      const Index j = apart.front();
      Add(*ahead_->source,
          fmt::format("the request begins elsewhere than the arm: {} at {:.4g} {}, where it stands "
                      "at {:.4g}{}",
                      JointText(j), begin[j], UnitOf(j), start_[j], AndMore(apart.size() - 1)));
    }
    const double last = ahead_->motion->times().back();
    if (last <= loaded_.simulator.duration) return;
    Add(*ahead_->source,
        fmt::format("the request ends at {:g} s, after the run, which ends at {:g} "
                    "s: the goal is not reached",
                    last, loaded_.simulator.duration));
  }

  /// Joints beside the arm that are asked to stay, and that what evades moves all the same.
  void JudgeBeside() {
    if (!Evades()) return;
    const std::vector<int> beside = planning::JointsBesideArm(model_);
    const std::vector<char> asked = AskedToMove();
    std::vector<std::string> held;
    for (const int j : beside) {
      const robot::Joint& joint = model_.joints()[static_cast<std::size_t>(j)];
      const bool task = std::any_of(beside.begin(), beside.end(), [&](int other) {
        return asked[static_cast<std::size_t>(PlaceOf(other))] != 0 && OneBranch(j, other);
      });
      if (task) continue;
      const double stays = ahead_->motion->Evaluate(0.0, 0)[joint.position_index];
      held.push_back(fmt::format("{}: {:.4g}", joint.name.text(), stays));
    }
    if (held.empty()) return;
    Add(*ahead_->source,
        fmt::format("what evades moves joints of model '{}' too that are not of its arm and that "
                    "nothing asks to move; `held: {{{}}}` of the model, or a `group`, holds them",
                    name_, fmt::join(held, ", ")));
  }

  Index PlaceOf(int joint) const {
    return model_.joints()[static_cast<std::size_t>(joint)].position_index;
  }

  /// Whether one of two joints carries the other, or they are one.
  bool OneBranch(int one, int other) const {
    int low = std::min(one, other);
    for (int j = std::max(one, other); j >= low; j = model_.joints()[j].parent_link - 1) {
      if (j == low) return true;
    }
    return false;
  }

  /// Whether what the arm does depends on distances that somebody measures.
  bool Evades() const {
    const auto upstream = loaded_.diagram->UpstreamOf(at_start_port_, Through::kStates).outputs;
    return std::any_of(upstream.begin(), upstream.end(), [](const auto& entry) {
      return entry.output.system->template role<systems::MeasuresDistances>() != nullptr;
    });
  }

  /// By position: whether the request moves it.
  std::vector<char> AskedToMove() const {
    const auto& times = ahead_->motion->times();
    const VectorXd first = ahead_->motion->Evaluate(times.front(), 0);
    std::vector<char> asked(static_cast<std::size_t>(first.size()), 0);
    for (int i = 1; i <= kRequestSamples; ++i) {
      const double time = times.front() + (times.back() - times.front()) * i / kRequestSamples;
      const VectorXd q = ahead_->motion->Evaluate(time, 0);
      for (Index j = 0; j < q.size(); ++j) {
        if (q[j] != first[j]) asked[static_cast<std::size_t>(j)] = 1;
      }
    }
    return asked;
  }

  static std::string AndMore(std::size_t joints) {
    return joints == 0 ? ""
                       : fmt::format("; and {} likewise", models::Counted(joints, "more joint"));
  }

  /// Of a derivative of the request: what is said of it.
  struct Demand {
    int derivative;
    const char *verb, *per, *consequence;
  };

  /// Looks at samples of the request's time.
  void JudgeRequest(const Demand& demand, const VectorXd& lower, const VectorXd& upper) {
    const auto& times = ahead_->motion->times();
    const double from = std::max(0.0, times.front());
    const double to = std::min(loaded_.simulator.duration, times.back());
    VectorXd excess = VectorXd::Zero(model_.num_positions());  // the most, of each joint
    VectorXd value(model_.num_positions());
    Index worst = -1;
    double worst_value = 0.0;
    double when = 0.0;
    for (int i = 0; i <= kRequestSamples && to >= from; ++i) {
      const double time = from + (to - from) * i / kRequestSamples;
      ahead_->motion->Evaluate(time, demand.derivative, value);
      for (Index j = 0; j < value.size(); ++j) {
        const double beyond = std::max(lower[j] - value[j], value[j] - upper[j]);
        const double limit = value[j] > upper[j] ? upper[j] : lower[j];
        if (!(beyond > kLimitRounding * std::max(1.0, std::fabs(limit)))) continue;
        if (beyond <= excess[j]) continue;
        excess[j] = beyond;
        if (excess.maxCoeff() > beyond) continue;
        worst = j;
        worst_value = value[j];
        when = time;
      }
    }
    if (worst < 0) return;
    const auto more = static_cast<std::size_t>((excess.array() > 0.0).count() - 1);
    const std::string limits =
        demand.derivative == 0
            ? fmt::format("its limits are [{:.4g}, {:.4g}]", lower[worst], upper[worst])
            : fmt::format("its limit is {:.4g}", upper[worst]);
    Add(*ahead_->source, fmt::format("{} is to {} {:.4g} {}{} at {:.3g} s; {}: {}{}",
                                     JointText(worst), demand.verb, worst_value, UnitOf(worst),
                                     demand.per, when, limits, demand.consequence, AndMore(more)));
  }

  void JudgeContacts() {
    std::optional<foresight::Foresight> scene;
    try {
      scene.emplace(*loaded_.diagram, loaded_.models, name_, loaded_.simulator.duration);
    } catch (const ConfigError&) {
      return;  // of what nobody knows beforehand
    }
    std::vector<robot::PlacedBody> bodies;
    for (const planning::BandBody& body : scene->bodies()) bodies.push_back({body.collider, {}});
    robot::Clearance clearance(scene->model(), scene->own_links(), bodies);
    for (const auto& [link, body] : scene->ignored()) clearance.Ignore(link, body);
    const double end = std::min(loaded_.simulator.duration, ahead_->motion->times().back());
    TellContact(*scene, clearance, *at_start_, start_, 0.0, "the arm starts");
    TellContact(*scene, clearance, *ahead_->source, ahead_->motion->Evaluate(end, 0), end,
                "the request ends");
    if (start_.size() != model_.num_positions()) return;
    if (const auto text = NoWayText(*scene)) Add(*ahead_->source, *text);
  }

  void TellContact(const foresight::Foresight& scene, robot::Clearance& clearance,
                   const System& system, const VectorXd& q, double time, const char* what) {
    if (q.size() != model_.num_positions()) return;
    for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
      clearance.MoveBody(static_cast<int>(i), scene.bodies()[i].pose(time));
    }
    clearance.MoveTo(q);
    const robot::NearPair nearest = clearance.Nearest(0.0);
    if (nearest.link < 0 || nearest.distance > 0.0) return;
    const auto& links = model_.links();
    const std::string other =
        nearest.body >= 0 ? scene.bodies()[static_cast<std::size_t>(nearest.body)].name.text()
                          : links[static_cast<std::size_t>(nearest.other_link)].name.text();
    Add(system, fmt::format("{} in contact: {} is {:.3g} m deep in {} at {:.3g} s", what,
                            links[static_cast<std::size_t>(nearest.link)].name.text(),
                            -nearest.distance, other, time));
  }

  const loading::LoadedDiagram& loaded_;
  const std::string name_;
  const robot::RobotModel& model_;
  std::optional<foresight::MotionAhead> ahead_;
  VectorXd start_;
  const System* at_start_{nullptr};
  OutputHandle at_start_port_{};
  std::vector<std::string> lines_;
};

}  // namespace

std::vector<std::string> RequestWarnings(const loading::LoadedDiagram& loaded) {
  std::vector<std::string> warnings;
  for (const auto& judge : loaded.diagram->FindRoles<systems::Judges>()) {
    if (!loaded.models.all().contains(loaded.models.FullName(judge.role->model))) continue;
    for (std::string& line : RequestJudge(loaded, *judge.role).Run()) {
      warnings.push_back(std::move(line));
    }
  }
  return warnings;
}

}  // namespace oca::runs
