// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/framework/dataflow/error_base.h"

namespace oca::models {

/// A robot description, a mesh or a shape is wrong. The text reads
/// `where: what; got X; expected Y` and `where` names the file and the element.
struct ModelError : Error {
  using Error::Error;
};

/// Collects what is wrong with one file, so that a person sees all of it at once.
class ModelErrors {
 public:
  /// Runs a part of the work and keeps what it throws.
  template <class Part>
  void Try(const Part& part) {
    try {
      part();
    } catch (const ModelError& error) {
      Add(error.what());
    }
  }
  void Add(std::string line) { lines_.push_back(std::move(line)); }
  bool empty() const { return lines_.empty(); }
  /// throws ModelError with a line for each, at most 50 of them, if there are any
  void Throw() const;

 private:
  std::vector<std::string> lines_;
};

}  // namespace oca::models
