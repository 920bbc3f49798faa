// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "oca/framework/dataflow/context.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/profile.h"
#include "oca/framework/dataflow/status.h"
#include "oca/framework/simulation/integration_method.h"
#include "oca/framework/simulation/pacer.h"

namespace oca {

class EventClock;
class WitnessLocator;

/// What a simulator did since Initialize.
struct SimulatorStatistics {
  std::int64_t steps{0};    ///< of the simulator: from one event to the next
  std::int64_t updates{0};  ///< discrete updates and resets that ran
  std::int64_t publishes{0};
  std::int64_t crossings{0};  ///< steps that a witness ended
  std::int64_t overruns{0};   ///< steps that ended after they were due on the wall clock
  double worst_overrun{0.0};  ///< s
  IntegratorStatistics integrator;
};

/// Advances a Context of a root diagram through discrete events and continuous time.
///
/// A step ends at the next discrete event, or earlier where a witness function reaches or crosses
/// zero: located to 1e-12 s (relative beyond 1 s), the earliest first, simultaneous ones and a tick
/// together. Its resets are the first stage of the following step.
///
/// One step at time t, from the state x-(t): resets; discrete updates; restart of the integrator if
/// something jumped; integration to the next event; publish; monitors. Each stage reads the result
/// of the one before; within a stage all events read the same state and are applied together.
///
/// AdvanceTo(T) ends at x-(T): updates due at T are pending, publishes at T have seen x-(T).
/// Initialize runs the initialization events, then publishes; the first periodic update at the
/// initial time belongs to the first step.
class Simulator {
 public:
  /// What a monitor wants: false ends AdvanceTo after the present step.
  using Monitor = std::function<bool(const Context&)>;
  using Publish = std::function<void(const Context&)>;

  /// Makes a Context of its own. The diagram must outlive the simulator.
  /// throws ConfigError if the options are out of bounds or the periods share no clock, WiringError
  /// if the diagram is nested.
  explicit Simulator(const Diagram& diagram, const IntegratorOptions& options = {});
  /// Continues `context`, which a simulator of the same diagram may have advanced before. If it
  /// was saved between two calls of AdvanceTo, or in a monitor at an instant whose updates restart
  /// the integrator, the run goes on with the same bits.
  /// throws WiringError if another diagram made the context.
  Simulator(const Diagram& diagram, Context context, const IntegratorOptions& options = {});
  ~Simulator();
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  const Diagram& diagram() const { return diagram_; }
  /// May be assigned a saved Context of the same diagram, or given another time; events that lie
  /// before the new time are skipped.
  Context& context() { return context_; }
  const Context& context() const { return context_; }

  /// Called at 0, period, 2 period, ... after the diagram's own publish events.
  /// throws ConfigError if the period is not positive or the simulator is already initialized.
  void AddPublish(const Period& period, Publish publish);
  /// Called after every step.
  void AddMonitor(Monitor monitor);
  /// Holds the end of every step until it is due, `factor` simulated seconds to a second of the
  /// wall clock, from the next AdvanceTo on; 0 runs as fast as possible. The clock must outlive the
  /// simulator.
  /// throws ConfigError if the factor is negative or not finite.
  void SetRealtimeFactor(double factor, WallClock& clock = WallClock::Steady());
  /// Sums up from now on what each system takes, which costs a look at the clock for every
  /// calculation.
  void EnableProfile();
  /// What each system took, in the diagram's order; empty without EnableProfile.
  std::vector<SystemTime> profile() const;
  /// Receives what publish events log; nullptr drops it.
  void SetLog(Log* log);

  /// Runs the initialization events and publishes at the context's time. Called by the first
  /// AdvanceTo if it was not before.
  /// throws SimulationError.
  void Initialize();
  /// Advances to `time` (s). Returns false if a monitor ended it earlier.
  /// throws ConfigError if `time` is not finite or lies in the past, SimulationError if a
  /// calculation fails; the context then holds the last state before the failure, and a further
  /// call tries again from there.
  bool AdvanceTo(double time);
  /// As AdvanceTo, but tells a failure instead of throwing it. A run that a monitor ended is fine;
  /// its context shows how far it came.
  Status TryAdvanceTo(double time) noexcept;

  const SimulatorStatistics& statistics() const { return statistics_; }

 private:
  struct OwnPublish {
    std::int64_t count;  ///< of the next one
    Publish publish;
  };

  void CheckContext() const;
  void ConnectLog();
  bool AdvanceSteps(double time);
  void Pace();
  void FollowTime();
  void SkipPublished(std::size_t own_publish);
  void RunStage(System::Stage stage);
  void RunPublishes();
  double NextEventTime() const;
  void AddPending(System::Stage stage);
  void ForgetPending(System::Stage stage);
  void Integrate(double to);

  const Diagram& diagram_;
  Context context_;
  std::unique_ptr<EventClock> clock_;
  std::unique_ptr<IntegrationMethod> integrator_;
  std::unique_ptr<WitnessLocator> locator_;
  std::vector<OwnPublish> publishes_;
  std::vector<Monitor> monitors_;
  std::vector<int> due_;  ///< events of the present stage
  std::unique_ptr<Pacer> pacer_;
  std::unique_ptr<Profile> profile_;
  Log* log_{nullptr};
  bool restart_{true};
  bool jumped_{false};
  bool initialized_{false};
  Eigen::VectorXd saved_state_;  ///< at the start of an integration, in case it fails
  SimulatorStatistics statistics_;
};

}  // namespace oca
