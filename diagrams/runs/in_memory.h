// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "oca/diagrams/runs/run_output.h"
#include "oca/framework/simulation/signal_log.h"

namespace oca::runs {

/// Keeps Vector signals of a run as matrices, a row a sample, a column a number:
///
///     InMemory series({"spline.position", "plant.position"}, Period(1, 100));
///     Run(loaded, {.outputs = {&series}});
///     const Eigen::MatrixXd all = series.Matrix();              // names() by its columns
///     const Eigen::MatrixXd q = series.Matrix("plant.position");
///
/// Times increase: where a run went on with another diagram there is the row before that.
class InMemory final : public RunOutput {
 public:
  /// `signals` as `system.output`; sampled at 0, period, 2 period, ...
  InMemory(std::vector<std::string> signals, const Period& period);

  /// throws ConfigError naming the signal and what there is if there is no such output, or it is no
  /// Vector; or if the period is not positive.
  void Prepare(const RunStart& run) override;
  void Begin(const RunStart& run) override;
  void End(const RunResult& /*result*/) override {}

  // Of the last run; throw ConfigError before the first.
  Eigen::VectorXd times() const;  ///< s, a number a row
  /// All signals side by side.
  Eigen::MatrixXd Matrix() const;
  /// The columns of one. throws ConfigError naming those that are kept if it is none of them.
  Eigen::MatrixXd Matrix(const std::string& signal) const;
  /// Of the columns of Matrix(): `plant.position[0]`, and what they are measured in.
  const std::vector<std::string>& names() const;
  const std::vector<std::string>& units() const;

 private:
  const SignalLog& first() const;
  template <class Part>
  Eigen::MatrixXd Stack(const Part& part) const;

  const std::vector<std::string> signals_;
  const Period period_;
  std::vector<std::unique_ptr<SignalLog>> logs_;  ///< one a diagram that the run went with
};

}  // namespace oca::runs
