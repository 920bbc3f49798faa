// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/model_set.h"

namespace oca::files {

/// A system type that diagram files can name. Parameters travel as `const void*` to a struct of its
/// own, which `fields` describe.
struct CatalogueRow {
  std::string type;
  SystemDoc doc;
  const std::vector<Field>& (*fields)();
  std::shared_ptr<void> (*new_params)();       ///< with their defaults
  std::shared_ptr<const void> example_params;  ///< of a small valid instance
  std::function<std::unique_ptr<System>(const void* params, const systems::ModelSet& models)> build;
  bool needs_models;

  /// Parameters as a file gives them, as `build` takes them; nullptr, with problems, if they are
  /// wrong. `where` is their path in the file.
  std::shared_ptr<const void> Read(const Value& given, const std::string& where,
                                   Problems& problems) const;
  /// A new system; nullptr, with problems, if the parameters, that Read made of `given`, are wrong.
  std::unique_ptr<System> Make(const void* params, const Value& given, const std::string& where,
                               const systems::ModelSet& models, Problems& problems) const;
  /// Both.
  std::unique_ptr<System> Make(const Value& given, const std::string& where,
                               const systems::ModelSet& models, Problems& problems) const;
  /// The small valid instance; a model that it needs is the `planar2` arm.
  /// throws ConfigError if the example is not what its fields say
  std::unique_ptr<System> MakeExample(const systems::ModelSet& models) const;

 private:
  std::unique_ptr<System> Build(const void* params, const systems::ModelSet& models) const;
};

/// What a class must have to be a row: parameters that describe themselves, what it says of itself,
/// and parameters of a small valid instance. It is made from its parameters, and from the robots of
/// the file if it has a constructor that takes them.
template <class S>
concept CatalogueSystem = std::derived_from<S, System> && ParamsStruct<typename S::Params> &&
    (std::constructible_from<S, const typename S::Params&> ||
     std::constructible_from<S, const typename S::Params&, const systems::ModelSet&>)&&requires {
  { S::kDoc } -> std::convertible_to<const SystemDoc&>;
  { S::Example() } -> std::convertible_to<typename S::Params>;
};

/// Parameters of a type that has none.
struct NoParams {
  static void Describe(Fields<NoParams>& /*fields*/) {}
};

/// The system types that a program knows, by name: a value, which whoever reads diagram files is
/// given. A program adds its own:
///
///     auto catalogue = Catalogue::Standard();
///     catalogue.Add<BatteryMonitor>("BatteryMonitor").Add<Winch>("Winch");
///     return tools::SimulatorMain(argc, argv, catalogue);
///
/// Copies share their rows, which never change.
class Catalogue {
 public:
  using Row = std::shared_ptr<const CatalogueRow>;

  /// No type at all.
  Catalogue() = default;
  /// All that come with OCA.
  static Catalogue Standard();

  /// Adds a class. All Adds throw ConfigError if the type is taken or no CamelCase name.
  template <CatalogueSystem S>
  Catalogue& Add(const std::string& type) {
    using P = typename S::Params;
    constexpr bool kNeedsModels = std::constructible_from<S, const P&, const systems::ModelSet&>;
    return AddRow(RowOf<P>(
        type, S::kDoc, S::Example(), kNeedsModels,
        [](const P& params, const systems::ModelSet& models) { return Make<S>(params, models); }));
  }
  /// Adds what `make` makes of parameters, as a lambda that calls MakeBlock; `example` are those of
  /// a small valid instance. The texts of `doc` must outlive the catalogue.
  template <ParamsStruct P>
  Catalogue& Add(const std::string& type, const SystemDoc& doc, const P& example,
                 std::type_identity_t<std::function<std::unique_ptr<System>(const P&)>> make) {
    return AddRow(RowOf<P>(type, doc, example, false,
                           [make = std::move(make)](const P& params, const systems::ModelSet&) {
                             return make(params);
                           }));
  }
  /// The same without parameters.
  Catalogue& Add(const std::string& type, const SystemDoc& doc,
                 std::function<std::unique_ptr<System>()> make) {
    return Add(type, doc, NoParams{}, [make = std::move(make)](const NoParams&) { return make(); });
  }
  Catalogue& AddRow(CatalogueRow row);

  /// By type name in alphabetic order.
  const std::vector<Row>& rows() const { return rows_; }
  /// throws ConfigError naming the nearest type.
  const Row& Find(const std::string& type) const;

 private:
  template <class S>
  static std::unique_ptr<System> Make(const typename S::Params& params,
                                      const systems::ModelSet& models) {
    if constexpr (std::constructible_from<S, const typename S::Params&, const systems::ModelSet&>) {
      return std::make_unique<S>(params, models);
    } else {
      return std::make_unique<S>(params);
    }
  }

  template <class P, class MakeOf>
  static CatalogueRow RowOf(const std::string& type, const SystemDoc& doc, const P& example,
                            bool needs_models, MakeOf make) {
    return {type,
            doc,
            &FieldsOf<P>,
            []() -> std::shared_ptr<void> { return std::make_shared<P>(); },
            std::make_shared<const P>(example),
            [make = std::move(make)](const void* params, const systems::ModelSet& models) {
              return make(*static_cast<const P*>(params), models);
            },
            needs_models};
  }

  std::vector<Row> rows_;
};

}  // namespace oca::files
