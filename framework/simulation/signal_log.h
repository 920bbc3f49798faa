// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "oca/framework/dataflow/period.h"
#include "oca/framework/dataflow/port.h"

namespace oca {

class Simulator;

/// Keeps the last samples of Vector outputs in memory, as a flight recorder does: a row a period,
/// at 0, period, 2 period, ... ; or all of them, as matrices for whoever evaluates a run:
///
///     const SignalLog log(simulator, {plant.position, plant.velocity}, Period(1, 100));
///     simulator.AdvanceTo(10.0);
///     const Eigen::MatrixXd values = log.Matrix();  // log.times(), log.names(), log.units()
class SignalLog {
 public:
  /// Attaches itself to the simulator, which must not be initialized yet, and must outlive the run.
  /// `capacity`: rows. All memory is taken here; a row that finds none left takes the place of the
  /// oldest.
  /// throws ConfigError if the capacity is not positive, the period is not positive or the
  /// simulator is already initialized, WiringError if an output is no Vector or of another diagram.
  SignalLog(Simulator& simulator, std::vector<OutputHandle> outputs, const Period& period,
            int capacity);
  /// The same without a bound: keeps every row, and takes memory as the run goes on.
  SignalLog(Simulator& simulator, std::vector<OutputHandle> outputs, const Period& period);
  SignalLog(const SignalLog&) = delete;
  SignalLog& operator=(const SignalLog&) = delete;

  int rows() const;                                               ///< kept, oldest first
  std::int64_t overwritten() const { return written_ - rows(); }  ///< rows that are gone
  double time(int row) const { return Row(row)[0]; }              ///< s
  VectorView values(int row, int signal) const;                   ///< of outputs[signal]

  /// s, a number a row.
  Eigen::VectorXd times() const;
  /// All outputs side by side, a row a sample, a column a number.
  Eigen::MatrixXd Matrix() const;
  /// The columns of outputs[signal] alone.
  Eigen::MatrixXd Matrix(int signal) const;
  /// Of the columns of Matrix(): `plant.position[0]`, and what they are measured in.
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::string>& units() const { return units_; }

 private:
  void Attach(Simulator& simulator, const Period& period);
  Eigen::MatrixXd Columns(int first, int count) const;
  void Sample(const Context& context);
  const double* Row(int row) const;

  std::vector<OutputHandle> outputs_;
  std::vector<int> begin_;  // of each output in a row, and the length of a row; the time is at 0
  std::vector<std::string> names_, units_;  // of the numbers in a row
  int capacity_{0};                         // rows; 0: all
  std::int64_t written_{0};                 // rows
  int next_{0};                             // row to write
  std::vector<double> data_;                // row by row
};

}  // namespace oca
