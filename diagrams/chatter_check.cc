// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/chatter_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "diagrams/catalogue.h"
#include "framework/dynamic_port.h"
#include "framework/port_access.h"
#include "framework/simulator.h"
#include "systems/delta_overlay.h"
#include "systems/delta_relaxation.h"
#include "systems/loop_gain.h"
#include "systems/robot_kinematics.h"

namespace oca::diagrams {
namespace {

using systems::ContactSlopes;
using systems::DeltaOverlay;
using systems::DeltaRelaxation;
using systems::JacobianMapping;
using systems::LoopGain;
using systems::RobotKinematics;

constexpr int kSamples = 100;
constexpr int kIterations = 6;
// Of the delta in one iteration, so that a force in deep penetration leads out step by step (rad).
constexpr double kLargestStep = 0.05;
// A delta that is still this far from rest after the last iteration says nothing (rad).
constexpr double kAtRest = 1e-3;

/// The systems of one loop.
struct Loop {
  const JacobianMapping* mapping{nullptr};
  const RobotKinematics* kinematics{nullptr};
  const DeltaRelaxation* relaxation{nullptr};  ///< nullptr: none
  const DeltaOverlay* overlay{nullptr};
  OutputHandle request{};
};

/// The next system on the way of a delta: what an output is called does not matter, an input does.
const System* After(const Diagram& diagram, const System& system) {
  for (int i = 0; i < std::ssize(system.outputs()); ++i) {
    for (const InputHandle& reader : diagram.ReadersOf({{&system, i}})) {
      const auto port = static_cast<std::size_t>(reader.index);
      if (reader.system->inputs()[port].name == "delta") return reader.system;
    }
  }
  return nullptr;
}

/// The loop that the mapping is part of, if it is of the known make and not switched off.
std::optional<Loop> LoopOf(const Diagram& diagram, const JacobianMapping& mapping) {
  Loop loop;
  loop.mapping = &mapping;
  const System* at = &mapping;
  for (int step = 0; step < 10 && loop.overlay == nullptr; ++step) {
    at = After(diagram, *at);
    if (at == nullptr) return std::nullopt;
    if (const auto* relaxation = dynamic_cast<const DeltaRelaxation*>(at)) {
      if (diagram.DriverOf(relaxation->relaxation_time)) return std::nullopt;  // it adapts
      loop.relaxation = relaxation;
    }
    loop.overlay = dynamic_cast<const DeltaOverlay*>(at);
  }
  if (loop.overlay == nullptr || !loop.overlay->params().enabled) return std::nullopt;
  if (!loop.overlay->params().period.positive()) return std::nullopt;
  const auto links = diagram.DriverOf(mapping.links);
  const auto request = diagram.DriverOf(loop.overlay->position_in);
  if (!links || !request) return std::nullopt;
  loop.kinematics = dynamic_cast<const RobotKinematics*>(links->system);
  loop.request = *request;
  if (loop.kinematics == nullptr) return std::nullopt;
  return loop;
}

/// A copy of what a loop computes its delta from, with the positions of the arm to be set.
class Probe {
 public:
  Probe(const LoadedDiagram& loaded, const Loop& loop) : loop_(loop) {
    Copy(loaded);
    const auto& mapping = dynamic_cast<const JacobianMapping&>(*copies_.at(loop.mapping));
    const auto& kinematics = dynamic_cast<const RobotKinematics&>(*copies_.at(loop.kinematics));
    LoopGain::Params params = LoopGain::Params{.period = loop.overlay->params().period};
    params.model = loop.mapping->params().model;
    params.alpha = loop.mapping->params().alpha;
    params.method = loop.mapping->params().method;
    params.damping = loop.mapping->params().damping;
    const auto& gain = builder_.Add<LoopGain>("loop_gain_", params, loaded.models);
    builder_.Connect(kinematics.links, gain.links);
    ConnectSlopes(gain);
    builder_.ExportInput("position", kinematics.position);
    builder_.ExportInput("velocity", kinematics.velocity);
    raw_ = mapping.delta;
    gain_ = gain.gain;
    request_ = {{copies_.at(loop.request.system), loop.request.index}};
    if (fields_.empty()) return;
    diagram_ = builder_.Build();
    position_ = diagram_->GetInput<Vector>("position");
    velocity_ = diagram_->GetInput<Vector>("velocity");
    simulator_.emplace(*diagram_);
    delta_ = Eigen::VectorXd::Zero(gain.num_positions());
    velocity_.Fix(simulator_->context(), delta_);
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
    const auto request = EvalVector(request_, context);
    const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXd>(request.data(), delta_.size());
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
  void Copy(const LoadedDiagram& loaded) {
    const Diagram& diagram = *loaded.diagram;
    std::vector<const System*> needed{loop_.mapping, loop_.kinematics, loop_.request.system};
    const auto drivers_of = [&](const System& system) {
      std::vector<std::pair<OutputHandle, InputHandle>> drivers;
      for (int i = 0; i < std::ssize(system.inputs()); ++i) {
        const InputHandle input{{&system, i}};
        if (const auto driver = diagram.DriverOf(input)) drivers.emplace_back(*driver, input);
      }
      return drivers;
    };
    for (std::size_t i = 0; i < needed.size(); ++i) {
      if (needed[i] == loop_.kinematics) continue;
      for (const auto& [from, to] : drivers_of(*needed[i])) {
        const bool known = std::find(needed.begin(), needed.end(), from.system) != needed.end();
        if (!known) needed.push_back(from.system);
      }
    }
    Problems problems;
    for (const auto& block : loaded.systems) {
      const System* const original = diagram.FindSystem(block.name);
      if (std::find(needed.begin(), needed.end(), original) == needed.end()) continue;
      auto copy = FindRow(block.type).make(block.params, block.name, loaded.models, problems);
      problems.Throw();
      copies_[original] = &builder_.AddSystem(block.name, std::move(copy));
    }
    for (const auto& [original, copy] : copies_) {
      if (original == loop_.kinematics) continue;
      for (const auto& [from, to] : drivers_of(*original)) {
        builder_.ConnectPorts({{copies_.at(from.system), from.index}}, {{copy, to.index}});
      }
    }
  }

  /// LoopGain takes the slopes of two fields; more than that no method has.
  void ConnectSlopes(const LoopGain& gain) {
    for (const auto& [original, copy] : copies_) {
      for (std::size_t i = 0; i < copy->outputs().size() && fields_.size() < 2; ++i) {
        if (copy->outputs()[i].type != &TypeOf<ContactSlopes>()) continue;
        const OutputHandle slopes{{copy, static_cast<int>(i)}};
        builder_.ConnectPorts(
            slopes, fields_.empty() ? InputHandle(gain.slopes) : InputHandle(gain.more_slopes));
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
  DiagramBuilder builder_;
  std::map<const System*, const System*> copies_;
  std::vector<Output<ContactSlopes>> fields_;
  Output<Vector> raw_;
  Output<Vector> gain_;
  OutputHandle request_;
  std::unique_ptr<Diagram> diagram_;
  Input<Vector> position_;
  Input<Vector> velocity_;
  std::optional<Simulator> simulator_;
  Eigen::VectorXd delta_;
};

/// The worst rest along the requested motion, if the loop is not stable there.
std::optional<std::string> Judge(const LoadedDiagram& loaded, const Loop& loop) {
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
  const double period = loop.overlay->params().period.seconds();
  const double given = loop.relaxation == nullptr ? 0.0 : loop.relaxation->params().relaxation_time;
  const double least = models::LeastRelaxationTime(worst.gain, period);
  if (std::max(given, period) > least) return std::nullopt;
  return fmt::format(
      "the loop must chatter: g = {:.3g} at rho = {:.2g} m ({} at {:.1f} s); stable needs "
      "relaxation_time > {:.2g} s, got {}",
      worst.gain, worst.distance, worst.link, when, least,
      loop.relaxation == nullptr ? "no DeltaRelaxation" : fmt::format("{:.3g} s", given));
}

}  // namespace

std::vector<std::string> ChatterWarnings(const LoadedDiagram& loaded) {
  std::vector<std::string> warnings;
  for (const auto& block : loaded.systems) {
    const System* const system = loaded.diagram->FindSystem(block.name);
    const auto* const mapping = dynamic_cast<const JacobianMapping*>(system);
    if (mapping == nullptr) continue;
    const auto loop = LoopOf(*loaded.diagram, *mapping);
    if (!loop) continue;
    std::optional<std::string> warning;
    try {
      warning = Judge(loaded, *loop);
    } catch (const std::exception& error) {
      warning = fmt::format("the gain of its loop could not be estimated: {}", error.what());
    }
    const auto named = std::find_if(
        loaded.systems.begin(), loaded.systems.end(), [&](const LoadedDiagram::Block& other) {
          const System* const found = loaded.diagram->FindSystem(other.name);
          return loop->relaxation == nullptr ? found == mapping : found == loop->relaxation;
        });
    if (warning) {
      warnings.push_back(fmt::format("{}: warning: systems.{}: {}",
                                     named->params.location().ToString(), named->name, *warning));
    }
  }
  return warnings;
}

void AddChatterWarnings(LoadedDiagram& loaded) {
  for (std::string& warning : ChatterWarnings(loaded)) {
    loaded.warnings.push_back(std::move(warning));
  }
}

}  // namespace oca::diagrams
