// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "oca/diagrams/files/document.h"

namespace oca::sweep {

/// One `--vary PATH=SPEC`: what a campaign changes from sample to sample.
///
///     report,safety_filter           every sample runs with each of the values
///     uniform(0.4, 1)                drawn for the sample, the lower bound included
///     uniform(0.4, 1, step=0.05)     the same from 0.4, 0.45, ..., 1
///     integers(2, 20)                drawn from 2, 3, ..., 20
///     choice(a, b, c)                drawn from the values
///
/// Values are YAML; commas within brackets and quotes belong to the value. What is drawn depends on
/// the seed of the sample and on PATH alone: not on other variations, nor on the combination.
class Variation {
 public:
  /// throws ConfigError that shows what is possible.
  static Variation Parse(const std::string& text);

  const std::string& path() const { return path_; }
  const std::string& text() const { return text_; }
  /// Whether every sample runs with each of the values.
  bool listed() const { return kind_ == Kind::kListed; }
  const std::vector<std::string>& values() const { return values_; }
  /// The value for the sample with this seed; not for a listed one.
  std::string Draw(std::uint64_t seed) const;

 private:
  enum class Kind { kListed, kUniform, kSteps, kChoice };
  void ParseCall(const std::string& name, const std::vector<std::string>& arguments);
  void ParseUniform(const std::vector<std::string>& arguments);
  void ParseIntegers(const std::vector<std::string>& arguments);
  [[noreturn]] void Refuse(const std::string& why) const;
  double Number(const std::string& text) const;

  std::string text_;
  std::string path_;
  Kind kind_{Kind::kListed};
  std::vector<std::string> values_;
  double lower_{0.0};
  double upper_{0.0};
  double step_{0.0};
  std::uint64_t count_{0};  ///< of steps
};

}  // namespace oca::sweep
