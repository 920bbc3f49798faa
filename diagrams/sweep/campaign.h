// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/files/override.h"
#include "oca/diagrams/loading/blueprint.h"
#include "oca/diagrams/sweep/variation.h"

namespace oca::sweep {

/// Which part of a campaign's samples a process runs: index, index + count, index + 2 count, ...
struct Shard {
  int index{0};
  int count{1};

  /// `results` of all samples, else `shard-INDEX-of-COUNT`: its files in the folder of a campaign.
  std::string Stem() const;
  /// Reads `INDEX/COUNT`, INDEX from 0.
  /// throws ConfigError
  static Shard Parse(const std::string& text);
};

/// Paths of parameters with their values as YAML.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// Independent runs of one diagram file: `samples` scenarios, each with every combination of the
/// listed values of `variations`. What is random in a sample follows from `seed` and its number.
struct Campaign {
  std::string file{};
  std::string name{};       ///< of the diagram
  std::string file_hash{};  ///< of everything that the runs are made from; FNV-1a, 64 bit, as hex
  std::vector<std::string> overrides{};  ///< PATH=VALUE for all
  std::vector<Variation> variations{};
  std::uint64_t seed{0};
  std::int64_t samples{0};
  std::optional<double> duration{};  ///< s; instead of the file's
  double arrival{0.01};              ///< a final error that counts as arrived, rad or m
  std::string version{};             ///< of the program

  /// `simulator.seed` of a sample: the upper 31 bits of models::Random::Seed(seed, sample).
  int SeedOf(std::int64_t sample) const;
  /// Products of the listed variations, the last one changing fastest; at least one, maybe empty.
  std::vector<Settings> Combinations() const;
  /// What the sample's seed drew.
  Settings Drawn(int sample_seed) const;
  /// All that the run of a sample overrides: `overrides`, the combination, what was drawn, seed.
  std::vector<files::Override> OverridesOf(int sample_seed, const Settings& combination) const;
  /// The command line that runs it alone.
  std::string CommandOf(int sample_seed, const Settings& combination) const;

  /// throws ConfigError if a path is set twice or by an override of the seed, if there are no
  /// samples or more than 10^9, or arrival or duration are out of bounds.
  void Check() const;

  /// One line of JSON, the first of a results file.
  std::string Header() const;
  /// throws ConfigError if it is none.
  static Campaign FromHeader(const std::string& line);
  /// What makes the results of two campaigns incomparable, as `seed: 1 against 2`; empty if
  /// nothing does. The path of the file does not.
  std::string DifferenceTo(const Campaign& other) const;
};

/// Builds the diagram, of the campaign's file, once for each combination, with the first of samples
/// 0 to 2 that can be built, and fills in `name` and `file_hash`. Returns the warnings of the
/// builds, each once.
/// throws ConfigError with the problems of the file if none can.
std::vector<std::string> Inspect(Campaign& campaign, const loading::Blueprint& blueprint);

}  // namespace oca::sweep
