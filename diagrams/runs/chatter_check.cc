// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/chatter_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "oca/diagrams/foresight/motion_ahead.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"
#include "oca/models/robot/loop_gain.h"
#include "oca/systems/signals/contact_slopes.h"
#include "oca/systems/signals/roles.h"

namespace oca::runs {
namespace {

using systems::AddsDelta;
using systems::CarriesDelta;
using systems::ContactSlopes;
using systems::Kinematics;
using systems::MapsForces;

constexpr int kSamples = 100;
constexpr int kIterations = 6;
// Of the delta in one iteration, so that a force in deep penetration leads out step by step (rad).
constexpr double kLargestStep = 0.05;
// A delta that is still this far from rest after the last iteration says nothing (rad).
constexpr double kAtRest = 1e-3;

/// The parts of one loop.
struct Loop {
  const System* mapping{nullptr};
  const System* kinematics{nullptr};
  const System* relaxation{nullptr};  ///< nullptr: none
  double relaxation_time{0.0};        ///< s, of that
  const System* overlay{nullptr};
  OutputHandle request{};
};

template <class Role>
const Role& RoleOf(const System& system) {
  return *system.role<Role>();
}

/// Follows a delta to where it is added to the request. False if it gets nowhere, or if what calms
/// the loop adapts itself.
bool FollowDelta(const Diagram& diagram, const OutputHandle& delta, int steps, Loop& loop) {
  for (const InputHandle& reader :
       steps > 0 ? diagram.ReadersOf(delta) : std::vector<InputHandle>{}) {
    const auto* const adds = reader.system->role<AddsDelta>();
    if (adds != nullptr && adds->delta == reader) {
      loop.overlay = reader.system;
      return true;
    }
    const auto* const carries = reader.system->role<CarriesDelta>();
    if (carries == nullptr || !(carries->in == reader)) continue;
    const InputHandle& adapts = carries->adapts;
    if (adapts.system != nullptr && diagram.DriverOf(adapts)) continue;
    if (!FollowDelta(diagram, carries->out, steps - 1, loop)) continue;
    if (carries->relaxation_time && loop.relaxation == nullptr) {
      loop.relaxation = reader.system;
      loop.relaxation_time = *carries->relaxation_time;
    }
    return true;
  }
  return false;
}

/// The loop that the mapping is part of, if it is of the known make and not switched off.
std::optional<Loop> LoopOf(const Diagram& diagram, const System& mapping, const MapsForces& maps) {
  constexpr int kMostSteps = 10;
  Loop loop;
  loop.mapping = &mapping;
  if (!FollowDelta(diagram, maps.delta, kMostSteps, loop)) return std::nullopt;
  const AddsDelta& adds = RoleOf<AddsDelta>(*loop.overlay);
  if (!adds.period.positive()) return std::nullopt;
  const auto links = diagram.DriverOf(maps.links);
  const auto request = diagram.DriverOf(adds.request);
  if (!links || !request || links->system->role<Kinematics>() == nullptr) return std::nullopt;
  loop.kinematics = links->system;
  loop.request = *request;
  return loop;
}

/// Whether a robot's motion comes from it: what is behind belongs to the loop of that robot.
bool GivesMotion(const System& system) {
  return system.role<Kinematics>() != nullptr || system.role<systems::Plant>() != nullptr;
}

/// A copy of what a loop computes its delta from, with the positions of the arm to be set: those
/// requested, which foresight knows, and the delta. Obstacles are as the loop's own sensing has
/// them; other robots are where their own loops lead them, whose forces are none of this one's.
class Probe {
 public:
  Probe(const loading::LoadedDiagram& loaded, const Loop& loop) : loop_(loop) {
    Copy(loaded);
    const auto& maps = RoleOf<MapsForces>(CopyOf(loop.mapping));
    const auto& kinematics = RoleOf<Kinematics>(CopyOf(loop.kinematics));
    const Period period = RoleOf<AddsDelta>(*loop.overlay).period;
    const System& gain = builder_.AddSystem("loop_gain_", maps.make_gain(period));
    builder_.ConnectPorts(kinematics.links, gain.FindInput("links"));
    ConnectSlopes(gain);
    builder_.ExportInput("position", kinematics.position);
    const bool has_velocity = kinematics.velocity.system != nullptr;
    if (has_velocity) builder_.ExportInput("velocity", kinematics.velocity);
    raw_ = Typed<Vector>(maps.delta);
    gain_ = Typed<Vector>(gain.FindOutput("gain"));
    if (fields_.empty()) return;
    const std::string where = loaded.diagram->PathOf(RoleOf<AddsDelta>(*loop.overlay).request);
    request_ = foresight::PositionsAheadOf(*loaded.diagram, loop.request,
                                           foresight::Samples::kShown, where)
                   .at;
    diagram_ = builder_.Build();
    position_ = diagram_->GetInput<Vector>("position");
    simulator_.emplace(*diagram_);
    delta_ = Eigen::VectorXd::Zero(diagram_->SizeOf(raw_));
    if (has_velocity) diagram_->GetInput<Vector>("velocity").Fix(simulator_->context(), delta_);
    position_.Fix(simulator_->context(), delta_);
    simulator_->Initialize();
  }

  /// False if no field says how its forces answer to distances.
  bool usable() const { return diagram_ != nullptr; }

  struct Rest {
    double gain{0.0};
    double distance{0.0};
    std::string link{};
  };
  /// Where the loop would rest at a time, later than the last; empty if it was not found.
  std::optional<Rest> RestAt(double time) {
    simulator_->AdvanceTo(time);
    const Context& context = simulator_->context();
    const Eigen::VectorXd q = request_(time);
    double away = 0.0;
    Rest rest;
    for (int i = 0; i < kIterations; ++i) {
      position_.Fix(simulator_->context(), Eigen::VectorXd(q + delta_));
      rest.gain = gain_.Eval(context)[0];
      Eigen::VectorXd step = (raw_.Eval(context) - delta_) / (1.0 + rest.gain);
      away = step.cwiseAbs().maxCoeff();
      if (away > kLargestStep) step *= kLargestStep / away;
      delta_ += step;
    }
    if (away > kAtRest) return std::nullopt;
    FindContact(rest);
    return rest;
  }

 private:
  void Copy(const loading::LoadedDiagram& loaded) {
    const Diagram& diagram = *loaded.diagram;
    const std::vector<const System*> needed = diagram.LeavesUpstream(
        {loop_.mapping, loop_.kinematics},
        [this](const System& system) { return &system == loop_.kinematics; });
    own_ = diagram.LeavesUpstream({loop_.mapping}, GivesMotion);
    Problems problems;
    std::set<std::string> names{"loop_gain_"};  // that of the gain
    for (const auto& block : loaded.systems) {
      const System* const original = diagram.FindSystem(block.name);
      if (std::find(needed.begin(), needed.end(), original) == needed.end()) continue;
      auto copy = block.row->Make(block.params, block.name, *block.models, problems);
      problems.Throw();
      // Two files that are used may each have one of that name.
      std::string name = block.name.substr(block.name.rfind('.') + 1);
      while (!names.insert(name).second) name += '_';
      copies_.emplace_back(original, &builder_.AddSystem(name, std::move(copy)));
    }
    for (const auto& [original, copy] : copies_) {
      if (original == loop_.kinematics) continue;
      for (const auto& [from, to] : diagram.DriversOf(*original)) {
        builder_.ConnectPorts({{&CopyOf(from.system), from.index}}, {{copy, to.index}});
      }
    }
  }

  const System& CopyOf(const System* original) const {
    return *std::find_if(copies_.begin(), copies_.end(), [&](const auto& entry) {
              return entry.first == original;
            })->second;
  }

  /// Those of the loop's own fields, of which the gain takes two; more than that no method has.
  void ConnectSlopes(const System& gain) {
    for (const auto& [original, copy] : copies_) {
      if (std::find(own_.begin(), own_.end(), original) == own_.end()) continue;
      for (std::size_t i = 0; i < copy->outputs().size() && fields_.size() < 2; ++i) {
        if (copy->outputs()[i].type != &TypeOf<ContactSlopes>()) continue;
        const OutputHandle slopes{{copy, static_cast<int>(i)}};
        builder_.ConnectPorts(slopes, gain.FindInput(fields_.empty() ? "slopes" : "more_slopes"));
        fields_.push_back(Typed<ContactSlopes>(slopes));
      }
    }
  }

  /// The contact that answers most.
  void FindContact(Rest& rest) const {
    double largest = 0.0;
    for (const auto& field : fields_) {
      for (const auto& contact : field.Eval(simulator_->context()).slopes) {
        if (contact.slope.norm() <= largest) continue;
        largest = contact.slope.norm();
        rest.link = contact.link.text();
        rest.distance = (contact.point_on_link - contact.point_on_obstacle).dot(contact.normal);
      }
    }
  }

  const Loop loop_;
  foresight::Positions request_;
  DiagramBuilder builder_;
  std::vector<std::pair<const System*, const System*>> copies_;  // of originals
  std::vector<const System*> own_;  // originals that compute this loop's delta and no other's
  std::vector<Output<ContactSlopes>> fields_;
  Output<Vector> raw_;
  Output<Vector> gain_;
  std::unique_ptr<Diagram> diagram_;
  Input<Vector> position_;
  std::optional<Simulator> simulator_;
  Eigen::VectorXd delta_;
};

/// The worst rest along the requested motion, if the loop is not stable there.
std::optional<std::string> Judge(const loading::LoadedDiagram& loaded, const Loop& loop) {
  Probe probe(loaded, loop);
  if (!probe.usable()) return std::nullopt;
  Probe::Rest worst;
  double when = 0.0;
  for (int i = 1; i <= kSamples; ++i) {
    const double time = loaded.simulator.duration * i / kSamples;
    const auto rest = probe.RestAt(time);
    if (!rest || rest->gain <= worst.gain) continue;
    worst = *rest;
    when = time;
  }
  const double period = RoleOf<AddsDelta>(*loop.overlay).period.seconds();
  const double least = robot::LeastRelaxationTime(worst.gain, period);
  if (std::max(loop.relaxation_time, period) > least) return std::nullopt;
  return fmt::format(
      "the loop must chatter: g = {:.3g} at rho = {:.2g} m ({} at {:.1f} s); stable needs "
      "relaxation_time > {:.2g} s, got {}",
      worst.gain, worst.distance, worst.link, when, least,
      loop.relaxation == nullptr ? "no relaxation" : fmt::format("{:.3g} s", loop.relaxation_time));
}

}  // namespace

std::vector<std::string> ChatterWarnings(const loading::LoadedDiagram& loaded) {
  std::vector<std::string> warnings;
  for (const auto& [path, mapping, maps] : loaded.diagram->FindRoles<MapsForces>()) {
    const auto loop = LoopOf(*loaded.diagram, *mapping, *maps);
    if (!loop) continue;
    std::optional<std::string> warning;
    try {
      warning = Judge(loaded, *loop);
    } catch (const std::exception& error) {
      warning = fmt::format("the gain of its loop could not be estimated: {}",
                            oca::internal::Explain(error));
    }
    if (!warning) continue;
    const auto& named = loaded.BlockOf(loop->relaxation == nullptr ? *mapping : *loop->relaxation);
    const std::string what = loading::OverridePath(named.name) + ": " + *warning;
    warnings.push_back(
        Diagnostic{named.params.location(), what, Diagnostic::Kind::kWarning}.ToString());
  }
  return warnings;
}

}  // namespace oca::runs
