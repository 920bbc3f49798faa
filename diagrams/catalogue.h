// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "framework/params.h"
#include "framework/system.h"
#include "systems/model_set.h"

namespace oca::diagrams {

/// A system type that diagram files can name.
struct CatalogueRow {
  std::string type;
  SystemDoc doc;
  const std::vector<Field>& (*fields)();
  /// A new system; nullptr, with problems, if the parameters are wrong. `where` is the path of the
  /// parameters in the file.
  std::function<std::unique_ptr<System>(const Value& params, const std::string& where,
                                        const systems::ModelSet& models, Problems& problems)>
      make;
  /// A small valid instance; a model that it needs is the `planar2` arm.
  std::function<std::unique_ptr<System>(const systems::ModelSet& models)> make_example;
  std::string (*example)();                ///< its parameters as JSON
  std::string (*schema)();                 ///< of its parameters
  std::vector<std::string> (*defaults)();  ///< one a field, as JSON
  bool needs_models;
  /// Its parameter `obstacles` is that of an ObstacleSource: what goals are to be clear of.
  bool says_obstacles;
};

/// Every system, by type name in alphabetic order.
const std::vector<CatalogueRow>& Catalogue();

/// throws ConfigError naming the nearest type.
const CatalogueRow& FindRow(const std::string& type);

}  // namespace oca::diagrams
