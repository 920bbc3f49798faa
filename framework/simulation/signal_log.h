// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "oca/framework/dataflow/period.h"
#include "oca/framework/dataflow/port.h"

namespace oca {

class Simulator;

/// Keeps the last samples of Vector outputs in memory, as a flight recorder does: a row a period,
/// at 0, period, 2 period, ... . All memory is taken in the constructor; a row that finds none left
/// takes the place of the oldest.
class SignalLog {
 public:
  /// Attaches itself to the simulator, which must not be initialized yet, and must outlive the run.
  /// `capacity`: rows.
  /// throws ConfigError if the capacity is not positive, the period is not positive or the
  /// simulator is already initialized, WiringError if an output is no Vector or of another diagram.
  SignalLog(Simulator& simulator, std::vector<OutputHandle> outputs, const Period& period,
            int capacity);
  SignalLog(const SignalLog&) = delete;
  SignalLog& operator=(const SignalLog&) = delete;

  int rows() const;                                               ///< kept, oldest first
  std::int64_t overwritten() const { return written_ - rows(); }  ///< rows that are gone
  double time(int row) const { return Row(row)[0]; }              ///< s
  VectorView values(int row, int signal) const;                   ///< of outputs[signal]

 private:
  void Sample(const Context& context);
  const double* Row(int row) const;

  std::vector<OutputHandle> outputs_;
  std::vector<int> begin_;    // of each output in a row, and the length of a row; the time is at 0
  int capacity_;              // rows
  std::int64_t written_{0};   // rows
  int next_{0};               // row to write
  std::vector<double> data_;  // row by row
};

}  // namespace oca
