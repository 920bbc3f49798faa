// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/sweep_run.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <set>
#include <thread>
#include <tuple>

#include "oca/diagrams/runs/run.h"
#include "oca/diagrams/sweep/crash_guard.h"
#include "oca/framework/dataflow/explain.h"

namespace oca::sweep {
namespace {

using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Looks at the clock after each step of one run.
class StepWatch {
 public:
  StepWatch(const SweepOptions& options, StepTimes& steps)
      : options_(options), steps_(steps), start_(Clock::now()) {}
  bool timed_out() const { return timed_out_; }

  bool Step() {
    const auto now = Clock::now();
    if (begun_) steps_.Add(std::chrono::duration<double>(now - last_).count());
    begun_ = true;  // the first step also made the context
    timed_out_ =
        options_.timeout && std::chrono::duration<double>(now - start_).count() > *options_.timeout;
    if (timed_out_ || (options_.interrupted && options_.interrupted())) return false;
    last_ = Clock::now();
    return true;
  }

 private:
  const SweepOptions& options_;
  StepTimes& steps_;
  Clock::time_point start_;
  Clock::time_point last_{};
  bool begun_{false};
  bool timed_out_{false};
};

void TakeResult(const runs::RunResult& result, SampleRow& row) {
  row.duration = result.duration;
  row.steps = result.statistics.steps;
  row.metrics = result.metrics;
  for (const runs::ExpectationResult& one : result.expectations) {
    if (one.ok) continue;
    const std::string got = one.value ? fmt::format("{}", *one.value) : "no value";
    row.unmet.push_back(fmt::format("{} {} (got {})", one.name, one.bound, got));
  }
  if (!result.failure) return;
  row.outcome = Outcome::kFailed;
  row.error = result.failure->message;
}

/// Hands out the runs of a shard that are not done yet, to any thread.
class Queue {
 public:
  Queue(const Campaign& campaign, const Shard& shard, const std::vector<SampleRow>& done)
      : campaign_(campaign),
        combinations_(campaign.Combinations()),
        step_(shard.count),
        sample_(shard.index) {
    for (const SampleRow& row : done) done_.insert(row.key());
  }

  struct Run {
    std::int64_t sample;
    int combination;
    const Settings& settings;
  };
  std::optional<Run> Next() {
    const std::lock_guard lock(mutex_);
    while (sample_ < campaign_.samples) {
      const Run run{sample_, combination_, combinations_[static_cast<std::size_t>(combination_)]};
      if (++combination_ == std::ssize(combinations_)) {
        combination_ = 0;
        sample_ += step_;
      }
      if (!done_.contains({run.sample, run.combination})) return run;
    }
    return std::nullopt;
  }

 private:
  const Campaign& campaign_;
  const std::vector<Settings> combinations_;
  const std::int64_t step_;
  std::set<std::tuple<std::int64_t, int>> done_;
  std::mutex mutex_;
  std::int64_t sample_;
  int combination_{0};
};

/// The threads of a sweep, and what they tell.
class Crew {
 public:
  Crew(const Campaign& campaign, const loading::Blueprint& blueprint, const Shard& shard,
       const SweepOptions& options, ResultFile& file)
      : campaign_(campaign),
        blueprint_(blueprint),
        options_(options),
        file_(file),
        queue_(campaign, shard, file.results().rows),
        all_(CountRuns(campaign, shard)),
        done_(std::ssize(file.results().rows)) {}

  void Work() {
    std::vector<std::thread> threads;
    working_ = options_.jobs;
    for (int i = 0; i < options_.jobs; ++i) threads.emplace_back([this] { Worker(); });
    {
      std::unique_lock lock(mutex_);
      while (working_ > 0) {
        ended_.wait_for(lock, std::chrono::milliseconds(100));
        if (options_.progress) options_.progress(done_, all_);
      }
    }
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
  }
  bool all_done() const { return done_ == all_; }

 private:
  void Worker() {
    try {
      while (!stop_ && !(options_.interrupted && options_.interrupted())) {
        const auto run = queue_.Next();
        if (!run) break;
        SampleTiming timing;
        const auto row = RunSampleGuarded(*run, timing);
        if (!row) break;
        file_.Add(*row, timing);
        const std::lock_guard lock(mutex_);
        ++done_;
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      stop_ = true;
    }
    const std::lock_guard lock(mutex_);
    --working_;
    ended_.notify_one();
  }

  std::optional<SampleRow> RunSampleGuarded(const Queue::Run& run, SampleTiming& timing) {
    SampleRow crashed;
    crashed.sample = run.sample;
    crashed.combination = run.combination;
    crashed.seed = campaign_.SeedOf(run.sample);
    crashed.set = run.settings;
    crashed.outcome = Outcome::kCrashed;
    crashed.error = "the program crashed in this run";
    const CrashGuard guard(file_.descriptor(), crashed.Line() + '\n');
    return RunSample(campaign_, blueprint_, run.sample, run.combination, run.settings, options_,
                     timing);
  }

  const Campaign& campaign_;
  const loading::Blueprint& blueprint_;
  const SweepOptions& options_;
  ResultFile& file_;
  Queue queue_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable ended_;
  const std::int64_t all_;
  std::int64_t done_;  ///< under mutex_, as all below
  int working_{0};
  std::exception_ptr error_;
};

}  // namespace

std::optional<SampleRow> RunSample(const Campaign& campaign, const loading::Blueprint& blueprint,
                                   std::int64_t sample, int combination, const Settings& settings,
                                   const SweepOptions& options, SampleTiming& timing) {
  SampleRow row;
  timing.sample = row.sample = sample;
  timing.combination = row.combination = combination;
  row.seed = campaign.SeedOf(sample);
  row.set = settings;
  for (auto& drawn : campaign.Drawn(row.seed)) row.set.push_back(std::move(drawn));
  row.outcome = Outcome::kNotLoaded;
  try {
    const auto start = Clock::now();
    const auto loaded = blueprint.Build(campaign.OverridesOf(row.seed, settings));
    timing.load_seconds = SecondsSince(start);
    row.outcome = Outcome::kFailed;
    StepWatch watch(options, timing.steps);
    runs::RunOptions run;
    run.duration = campaign.duration;
    run.realtime_factor = 0.0;
    run.progress = [&watch](double) { return watch.Step(); };
    const runs::RunResult result = runs::Run(loaded, run);
    timing.run_seconds = result.wall_seconds;
    row.outcome = Outcome::kFinished;
    if (result.interrupted && !watch.timed_out()) return std::nullopt;
    TakeResult(result, row);
    if (watch.timed_out()) {
      row.outcome = Outcome::kTimedOut;
      row.error = fmt::format("took longer than {} s", *options.timeout);
    }
  } catch (const std::exception& error) {
    row.error = oca::internal::Explain(error);
  }
  return row;
}

std::int64_t CountRuns(const Campaign& campaign, const Shard& shard) {
  const std::int64_t samples = (campaign.samples - shard.index + shard.count - 1) / shard.count;
  return std::max<std::int64_t>(0, samples) * std::ssize(campaign.Combinations());
}

bool RunSweep(const Campaign& campaign, const loading::Blueprint& blueprint, const Shard& shard,
              const SweepOptions& options, ResultFile& file) {
  if (file.complete()) return true;
  Crew crew(campaign, blueprint, shard, options, file);
  crew.Work();
  if (!crew.all_done()) return false;
  file.Finish();
  return true;
}

}  // namespace oca::sweep
