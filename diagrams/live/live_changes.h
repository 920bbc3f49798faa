// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/live/live_run.h"
#include "oca/diagrams/loading/blueprint.h"

namespace oca::live {

/// What clients of a server change in a run, and what they are told of it.
class LiveChanges final : public runs::RunHook {
 public:
  /// Loads the diagram and tells its parameters. throws ConfigError if it cannot be loaded.
  LiveChanges(const LiveRunOptions& options, LiveServer& server);
  ~LiveChanges() override;

  /// The diagram that the run has now.
  const std::shared_ptr<const loading::LoadedDiagram>& loaded() const { return loaded_; }
  /// Changes that took effect.
  int count() const { return count_; }

  /// Puts obstacles where they were moved to, and all others where the file has them.
  void Prepare(const loading::LoadedDiagram& loaded, Context& context) override;
  bool WantsChange() override;
  void Change(runs::RunControl& run) override;

 private:
  /// Where obstacles were moved to from where the file has them, m, by the names of their
  /// positions.
  using Moves = std::map<std::string, Eigen::Vector3d>;

  std::shared_ptr<const loading::LoadedDiagram> Build(
      const std::vector<files::Override>& overrides) const;
  static void Place(const Moves& moves, const loading::LoadedDiagram& loaded, Context& context);
  std::vector<LiveParameter> Parameters() const;
  std::optional<Eigen::Vector3d> MoveOf(const LiveParameter& change) const;
  void BeginChange();
  void BeginJudging();
  void Move(runs::RunControl& run);
  void Replace(runs::RunControl& run);
  void TellWarnings(const std::vector<std::string>& warnings, runs::RunControl& run);
  void Warn(const std::string& warning) const;
  void Refuse(const std::string& why);

  const LiveRunOptions& options_;
  LiveServer& server_;
  const loading::Blueprint blueprint_;
  std::vector<files::Override> overrides_, wanted_;
  std::shared_ptr<const loading::LoadedDiagram> loaded_;
  Moves moves_, moved_;  ///< in effect; asked for
  std::future<std::shared_ptr<const loading::LoadedDiagram>> next_;
  std::vector<std::string> told_;  ///< what was warned of
  std::shared_ptr<const loading::LoadedDiagram> judged_;
  std::future<std::vector<std::string>> judgement_;  ///< what that one is warned of
  int count_{0};
};

}  // namespace oca::live
