// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/live_session.h"

#include <exception>

#include "oca/diagrams/live/adopt_state.h"
#include "oca/diagrams/live/live_parameters.h"
#include "oca/framework/dataflow/port_access.h"

namespace oca::live {

LiveSession::LiveSession(loading::LoadedDiagram loaded, record::RecorderOptions options,
                         std::vector<record::RecordSink*> sinks, double realtime_factor, Log* log)
    : loaded_(std::make_shared<const loading::LoadedDiagram>(std::move(loaded))),
      recorder_(*loaded_, std::move(options), std::move(sinks), log),
      simulator_(*loaded_->diagram, loaded_->simulator.integration) {
  simulator_.SetLog(&recorder_);
  simulator_.SetRealtimeFactor(realtime_factor);
}

void LiveSession::Start(Simulator::Monitor monitor) {
  simulator_.AddMonitor(std::move(monitor));
  recorder_.Attach(simulator_, true, kLiveDuration);
  attached_ = true;
}

void LiveSession::Adopt(const LiveSession& previous) {
  const Context& old = previous.simulator_.context();
  Simulator trial(*loaded_->diagram, simulator_.context(), loaded_->simulator.integration);
  AdoptFrom(previous, old, trial.context());
  trial.Initialize();
  AdoptFrom(previous, old, simulator_.context());
}

void LiveSession::StartFrom(const LiveSession& previous, Simulator::Monitor monitor) {
  Start(std::move(monitor));
  simulator_.Initialize();  // which writes states
  AdoptFrom(previous, previous.simulator_.context(), simulator_.context());
}

void LiveSession::End(runs::RunResult result) {
  if (!attached_) return;
  attached_ = false;
  result.duration = simulator_.context().time();
  try {
    recorder_.Finish(result);
  } catch (const std::exception&) {
    // nobody is left to be shown anything
  }
}

void LiveSession::Place(const Moves& moves) {
  std::map<std::string, Eigen::VectorXd> offsets;
  for (const System::InputInfo& input : loaded_->diagram->inputs()) {
    const int size = loaded_->diagram->SizeOf(loaded_->diagram->FindInput(input.name));
    offsets[input.name] = Eigen::VectorXd::Zero(size);
  }
  for (const auto& [id, standing] : StandingObstacles(*loaded_)) {
    const auto move = moves.find(PositionName(id));
    const auto offset = offsets.find(standing.input);
    if (move == moves.end() || offset == offsets.end()) continue;
    offset->second.segment<3>(static_cast<Eigen::Index>(standing.first)) = move->second;
  }
  for (const auto& [name, offset] : offsets) {
    loaded_->diagram->GetInput<Vector>(name).Fix(simulator_.context(), offset);
  }
}

void LiveSession::AdoptFrom(const LiveSession& previous, const Context& from, Context& to) const {
  to.SetTime(from.time());
  AdoptStates(*previous.loaded_->diagram, from, *loaded_->diagram, to);
}

}  // namespace oca::live
