// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/live_changes.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "oca/diagrams/record/run_metadata.h"
#include "oca/diagrams/runs/run_warnings.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/port_access.h"

namespace oca::live {
namespace {

using files::Override;
using loading::LoadedDiagram;

/// A later override of a path takes the place of an earlier one.
void Put(std::vector<Override>& overrides, const Override& one) {
  std::erase_if(overrides, [&](const Override& other) { return other.path == one.path; });
  overrides.push_back(one);
}

template <class T>
bool Ready(const std::future<T>& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

LiveChanges::LiveChanges(const LiveRunOptions& options, LiveServer& server)
    : options_(options),
      server_(server),
      blueprint_(options.file, options.catalogue),
      overrides_(options.overrides) {
  LoadedDiagram loaded = blueprint_.Build(overrides_, {.movable = true});
  runs::AddRunWarnings(loaded);
  for (const std::string& warning : loaded.warnings) Warn(warning);
  told_ = loaded.warnings;
  loaded_ = judged_ = std::make_shared<const LoadedDiagram>(std::move(loaded));
  server_.SetParameters(Parameters());
  server_.AddMetadata({"oca.ranges", RangesOf(*loaded_)});
}

LiveChanges::~LiveChanges() {
  if (next_.valid()) next_.wait();
}

std::shared_ptr<const LoadedDiagram> LiveChanges::Build(
    const std::vector<Override>& overrides) const {
  return std::make_shared<const LoadedDiagram>(blueprint_.Build(overrides, {.movable = true}));
}

void LiveChanges::Warn(const std::string& warning) const {
  if (options_.warned) options_.warned(warning);
}

void LiveChanges::Prepare(const LoadedDiagram& loaded, Context& context) {
  Place(moves_, loaded, context);
}

bool LiveChanges::WantsChange() {
  if (!next_.valid()) BeginChange();
  if (!judgement_.valid()) BeginJudging();
  return !moved_.empty() || Ready(next_) || Ready(judgement_);
}

void LiveChanges::Change(runs::RunControl& run) {
  if (Ready(judgement_)) {
    const std::vector<std::string> warnings = judgement_.get();
    if (judged_ == loaded_) TellWarnings(warnings, run);
  }
  if (!moved_.empty()) Move(run);
  if (Ready(next_)) Replace(run);
}

/// What takes long to find out about a changed diagram is found elsewhere, and no change waits for
/// it.
void LiveChanges::BeginJudging() {
  if (judged_ == loaded_) return;
  judged_ = loaded_;
  judgement_ = std::async(std::launch::async, [loaded = judged_] {
    std::vector<std::string> warnings = loaded->warnings;
    for (std::string& one : runs::RunWarnings(*loaded)) warnings.push_back(std::move(one));
    return warnings;
  });
}

void LiveChanges::TellWarnings(const std::vector<std::string>& warnings, runs::RunControl& run) {
  if (warnings == told_) return;
  for (const std::string& warning : warnings) {
    if (std::find(told_.begin(), told_.end(), warning) == told_.end()) Warn(warning);
  }
  run.SetWarnings(warnings);
  told_ = warnings;
  server_.AddMetadata({"oca.warnings", record::WarningTexts(warnings)});
  server_.ShowMetadata();
}

/// The file's parameters, with obstacles where they were moved to.
std::vector<LiveParameter> LiveChanges::Parameters() const {
  std::vector<LiveParameter> parameters = LiveParametersOf(*loaded_);
  for (LiveParameter& parameter : parameters) {
    const auto move = moves_.find(parameter.name);
    auto* const position = std::get_if<std::vector<double>>(&parameter.value);
    if (move == moves_.end() || position == nullptr) continue;
    for (int i = 0; i < 3; ++i) (*position)[static_cast<std::size_t>(i)] += move->second[i];
  }
  return parameters;
}

/// Whether an obstacle can be moved by an input, and by how much that is.
std::optional<Eigen::Vector3d> LiveChanges::MoveOf(const LiveParameter& change) const {
  const auto* const position = std::get_if<std::vector<double>>(&change.value);
  if (position == nullptr) return std::nullopt;
  const auto& inputs = loaded_->diagram->exported_inputs();
  for (const auto& [name, standing] : StandingObstacles(*loaded_)) {
    if (change.name != name) continue;
    const bool exported =
        std::any_of(inputs.begin(), inputs.end(),
                    [&input = standing.input](const auto& one) { return one.name == input; });
    if (!exported) return std::nullopt;
    return Eigen::Vector3d(Eigen::Vector3d::Map(position->data()) -
                           Eigen::Vector3d::Map(standing.position.data()));
  }
  return std::nullopt;
}

/// Takes what clients asked for: moves for the next tick; for the rest, builds the diagram
/// elsewhere.
void LiveChanges::BeginChange() {
  const std::vector<LiveParameter> changes = server_.TakeChanges();
  if (changes.empty()) return;
  wanted_ = overrides_;
  bool load = false;
  try {
    for (const LiveParameter& change : changes) {
      if (const auto move = MoveOf(change)) {
        moved_[change.name] = *move;
      } else {
        Put(wanted_, OverrideOf(*loaded_, change));
        load = true;
      }
    }
  } catch (const std::exception& error) {
    return Refuse(oca::internal::Explain(error));
  }
  if (!load) return;
  next_ = std::async(std::launch::async, [this, wanted = wanted_] { return Build(wanted); });
}

void LiveChanges::Place(const Moves& moves, const LoadedDiagram& loaded, Context& context) {
  std::map<std::string, Eigen::VectorXd> offsets;
  for (const System::InputInfo& input : loaded.diagram->inputs()) {
    const int size = loaded.diagram->SizeOf(loaded.diagram->FindInput(input.name));
    offsets[input.name] = Eigen::VectorXd::Zero(size);
  }
  for (const auto& [name, standing] : StandingObstacles(loaded)) {
    const auto move = moves.find(name);
    const auto offset = offsets.find(standing.input);
    if (move == moves.end() || offset == offsets.end()) continue;
    offset->second.segment<3>(static_cast<Eigen::Index>(standing.first)) = move->second;
  }
  for (const auto& [input, offset] : offsets) {
    loaded.diagram->GetInput<Vector>(input).Fix(context, offset);
  }
}

void LiveChanges::Move(runs::RunControl& run) {
  Moves moves = moves_;
  for (const auto& [name, move] : moved_) moves[name] = move;
  moved_.clear();
  try {
    Place(moves, *loaded_, run.context());
    moves_ = std::move(moves);
    ++count_;
  } catch (const std::exception& error) {
    Refuse(oca::internal::Explain(error));
  }
}

void LiveChanges::Replace(runs::RunControl& run) {
  try {
    auto next = next_.get();
    run.Replace(next);
    loaded_ = std::move(next);
    overrides_ = wanted_;
    ++count_;
    server_.SetParameters(Parameters());
  } catch (const std::exception& error) {
    Refuse(oca::internal::Explain(error));
  }
}

void LiveChanges::Refuse(const std::string& why) {
  if (options_.refused) options_.refused(why);
  server_.Tell(StatusLevel::kError, "change refused: " + why);
  server_.SetParameters(Parameters());
}

}  // namespace oca::live
