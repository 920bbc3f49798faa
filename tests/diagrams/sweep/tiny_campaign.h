// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/diagrams/sweep/campaign.h"
#include "oca/diagrams/sweep/result_file.h"
#include "oca/diagrams/sweep/sweep_run.h"
#include "tests/temporary_folder.h"

namespace oca::sweep {

/// A diagram that takes no time: ten times a ramp, which should end at a goal. A slope of 1e308
/// fails in the run, `gain: word` when it is loaded.
inline const char* const kTinyDiagram = R"(name: tiny
parameters: {slope: 1, goal: 5, gain: 10}
simulator: {duration: 1}
systems:
  source: {type: RampSource, slope: "${slope}"}
  gain: {type: Gain, gain: "${gain}"}
  goal: {type: Constant, value: "${goal}"}
  metrics: {type: MotionMetrics, period: 0.1}
connections:
  - source.value -> gain.in
  - gain.out -> metrics.position
  - source.value -> metrics.request
  - goal.value -> metrics.goal
)";

/// 12 samples of it, each with two goals.
inline Campaign TinyCampaign(const test::TemporaryFolder& folder) {
  Campaign campaign;
  campaign.file = folder.Write("tiny.yaml", kTinyDiagram).string();
  campaign.variations = {Variation::Parse("parameters.goal=5,7"),
                         Variation::Parse("parameters.slope=uniform(0.4, 0.8, step=0.1)")};
  campaign.seed = 3;
  campaign.samples = 12;
  campaign.version = "test";
  return campaign;
}

inline std::string Text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs a shard into a folder; returns the text of its results.
inline std::string RunShard(const Campaign& campaign, const std::filesystem::path& folder,
                            const Shard& shard = {}, const SweepOptions& options = {}) {
  Campaign inspected = campaign;
  const loading::Blueprint blueprint(campaign.file);
  Inspect(inspected, blueprint);
  ResultFile file(folder, inspected, shard);
  RunSweep(inspected, blueprint, shard, options, file);
  return Text(folder / (shard.Stem() + ".jsonl"));
}

}  // namespace oca::sweep
