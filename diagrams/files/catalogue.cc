// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <exception>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::files {
namespace {

/// A value is missing, as that of an expression which could not be worked out.
bool HasGap(const Value& value) {
  if (value.null()) return true;
  if (const Value::List* const list = value.list()) {
    return std::any_of(list->begin(), list->end(), HasGap);
  }
  if (const Value::Map* const map = value.map()) {
    return std::any_of(map->begin(), map->end(),
                       [](const Value::Entry& entry) { return HasGap(entry.value); });
  }
  return false;
}

bool IsCamelCase(const std::string& name) {
  const auto is = [](int (*kind)(int)) {
    return [kind](char c) { return kind(static_cast<unsigned char>(c)) != 0; };
  };
  return !name.empty() && is(std::isupper)(name.front()) &&
         std::all_of(name.begin(), name.end(), is(std::isalnum)) &&
         (name.size() == 1 || std::any_of(name.begin(), name.end(), is(std::islower)));
}

/// What a file could not name, or twice.
void CheckKeys(const CatalogueRow& row) {
  std::vector<std::string> keys{"type"};
  for (const Field& field : row.fields()) {
    if (std::find(keys.begin(), keys.end(), field.key) != keys.end()) {
      throw ConfigError(
          fmt::format("catalogue: type '{}': parameter; got '{}', which is taken; "
                      "expected a key of its own",
                      row.type, field.key));
    }
    keys.push_back(field.key);
  }
}

bool Before(const Catalogue::Row& row, const std::string& type) { return row->type < type; }

}  // namespace

std::shared_ptr<const void> CatalogueRow::Read(const Value& given, const std::string& where,
                                               Problems& problems) const {
  std::shared_ptr<void> read = new_params();
  Problems own;
  ReadFields(given, fields(), where, read.get(), own);
  problems.Add(own);
  return own.empty() ? read : nullptr;
}

std::unique_ptr<System> CatalogueRow::Make(const Value& given, const std::string& where,
                                           const systems::ModelSet& models,
                                           Problems& problems) const {
  const std::shared_ptr<const void> params = Read(given, where, problems);
  return params == nullptr ? nullptr : Make(params.get(), given, where, models, problems);
}

std::unique_ptr<System> CatalogueRow::Make(const void* params, const Value& given,
                                           const std::string& where,
                                           const systems::ModelSet& models,
                                           Problems& problems) const {
  try {
    return Build(params, models);
  } catch (const WiringError&) {
    throw;  // of the class, not of its parameters
  } catch (const std::exception& error) {
    // One that follows from what has been reported says nothing new.
    if (problems.empty() || !HasGap(given)) {
      problems.Add(given.location(),
                   (where.empty() ? "" : where + ": ") + oca::internal::Explain(error));
    }
  }
  return nullptr;
}

std::unique_ptr<System> CatalogueRow::MakeExample(const systems::ModelSet& models) const {
  std::vector<std::string> wrong;
  CheckFields(fields(), example_params.get(), new_params().get(), "", wrong);
  if (!wrong.empty()) {
    throw ConfigError(fmt::format("catalogue: type '{}': example; got {}", type, wrong.front()));
  }
  return Build(example_params.get(), models);
}

std::unique_ptr<System> CatalogueRow::Build(const void* params,
                                            const systems::ModelSet& models) const {
  std::unique_ptr<System> system = build(params, models);
  if (system != nullptr) return system;
  throw ConfigError(fmt::format("catalogue: type '{}': made nothing; expected a system", type));
}

Catalogue& Catalogue::AddRow(CatalogueRow row) {
  if (!IsCamelCase(row.type)) {
    throw ConfigError(
        fmt::format("catalogue: type; got '{}'; expected a name such as MyBlock: "
                    "letters and digits, first a capital",
                    row.type));
  }
  CheckKeys(row);
  if (row.type == kDiagramType) {
    throw ConfigError(fmt::format(
        "catalogue: type; got '{}', which is a diagram file; expected another", row.type));
  }
  const auto place = std::lower_bound(rows_.begin(), rows_.end(), row.type, Before);
  if (place != rows_.end() && (*place)->type == row.type) {
    throw ConfigError(
        fmt::format("catalogue: type; got '{}', which is taken; expected a new one", row.type));
  }
  rows_.insert(place, std::make_shared<const CatalogueRow>(std::move(row)));
  return *this;
}

const Catalogue::Row& Catalogue::Find(const std::string& type) const {
  const auto place = std::lower_bound(rows_.begin(), rows_.end(), type, Before);
  if (place != rows_.end() && (*place)->type == type) return *place;
  std::vector<std::string> types;
  for (const Row& row : rows_) types.push_back(row->type);
  types.emplace_back(kDiagramType);
  throw ConfigError(fmt::format("no system type '{}'{} (`simulator list` shows all)", type,
                                DidYouMean(type, types)));
}

}  // namespace oca::files
