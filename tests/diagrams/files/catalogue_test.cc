// SPDX-License-Identifier: BSD-3-Clause
// The types of systems as a value that programs add to.
#include "oca/diagrams/files/catalogue.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/function.h"
#include "tests/temporary_folder.h"

namespace oca::files {
namespace catalogue_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// out = factor in, with a factor that is not 13.
class Foreign final : public System {
 public:
  static constexpr SystemDoc kDoc{"is of nobody's", "out = factor in", ""};
  struct Params {
    double factor{2.0};
    static void Describe(Fields<Params>& fields) {
      fields.Add("factor", &Params::factor, "", "of the input").AtLeast(0.0);
    }
  };
  static Params Example() { return {.factor = 3.0}; }
  explicit Foreign(const Params& params)
      : factor_(params.factor),
        in(DeclareInput<Vector>("in")),
        out(DeclareOutput<Vector, &Foreign::Calc>("out", {1}, in)) {
    if (factor_ == 13.0) throw std::invalid_argument("brings bad luck");
  }

 private:
  const double factor_;
  void Calc(VectorView x, MutableVectorView y) const { y = factor_ * x; }

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

struct TwinParams {
  double one{0.0};
  double two{0.0};
  static void Describe(Fields<TwinParams>& fields) {
    fields.Add("same", &TwinParams::one, "", "first");
    fields.Add("same", &TwinParams::two, "", "second");
  }
};

std::unique_ptr<System> MakeNorm() {
  return MakeBlock({.inputs = {{"in"}}, .output = {"out", 1}},
                   [](VectorView in) { return in.norm(); });
}
constexpr SystemDoc kNormDoc{"length of a vector", "out = |in|", ""};

std::vector<std::string> TypesOf(const Catalogue& catalogue) {
  std::vector<std::string> types;
  for (const Catalogue::Row& row : catalogue.rows()) types.push_back(row->type);
  return types;
}

TEST(CatalogueTest, IsInAlphabeticOrderWithoutDoubles) {
  auto catalogue = Catalogue::Standard();
  catalogue.Add<Foreign>("Foreign").Add("Aardvark", kNormDoc, MakeNorm);
  const std::vector<std::string> types = TypesOf(catalogue);
  EXPECT_EQ(types.front(), "Aardvark");
  EXPECT_TRUE(std::is_sorted(types.begin(), types.end()));
  EXPECT_EQ(std::set<std::string>(types.begin(), types.end()).size(), types.size());
  EXPECT_EQ(types.size(), TypesOf(Catalogue::Standard()).size() + 2) << "the standard one grew";
}

TEST(CatalogueTest, NamesTheNearestOfAnUnknownType) {
  auto catalogue = Catalogue::Standard();
  EXPECT_EQ(catalogue.Find("Gain")->type, "Gain");
  EXPECT_THAT([&] { catalogue.Find("DeltaLimter"); },
              ThrowsMessage<ConfigError>(HasSubstr("did you mean 'DeltaLimiter'?")));
  EXPECT_THAT([&] { catalogue.Find("Foreign"); }, testing::Throws<ConfigError>());
  catalogue.Add<Foreign>("Foreign");
  EXPECT_THAT([&] { catalogue.Find("Foreing"); },
              ThrowsMessage<ConfigError>(HasSubstr("did you mean 'Foreign'?")));
}

TEST(CatalogueTest, RefusesATypeThatIsTaken) {
  auto catalogue = Catalogue::Standard();
  EXPECT_THAT([&] { catalogue.Add<Foreign>("Gain"); },
              ThrowsMessage<ConfigError>(AllOf(HasSubstr("'Gain'"), HasSubstr("taken"))));
  EXPECT_THAT([&] { catalogue.Add<Foreign>("Foreign").Add<Foreign>("Foreign"); },
              ThrowsMessage<ConfigError>(AllOf(HasSubstr("'Foreign'"), HasSubstr("taken"))));
}

TEST(CatalogueTest, RefusesWhatIsNoCamelCaseName) {
  for (const char* name :
       {"", "foreign", "my_block", "My Block", "My_Block", "1Block", "MY", "Ölig"}) {
    EXPECT_THAT([&] { Catalogue().Add<Foreign>(name); },
                ThrowsMessage<ConfigError>(HasSubstr(std::string("'") + name + "'")))
        << name;
  }
  for (const char* name : {"Foreign", "MyBlock2", "PIDGain", "X"}) {
    EXPECT_NO_THROW(Catalogue().Add<Foreign>(name)) << name;
  }
}

TEST(CatalogueTest, RefusesParametersThatAFileCannotTellApart) {
  EXPECT_THAT(
      [] {
        Catalogue().Add("Twin", kNormDoc, TwinParams{},
                        [](const TwinParams&) { return MakeNorm(); });
      },
      ThrowsMessage<ConfigError>(AllOf(HasSubstr("'Twin'"), HasSubstr("'same'"))));
}

TEST(CatalogueTest, ARowOfACallableHasParametersTooIfItWants) {
  Catalogue catalogue;
  catalogue.Add("Scale", kNormDoc, Foreign::Params{4.0}, [](const Foreign::Params& params) {
    return MakeBlock(
        {.inputs = {{"in"}}, .output = {"out"}},
        [factor = params.factor](VectorView in, MutableVectorView out) { out = factor * in; });
  });
  const CatalogueRow& row = *catalogue.Find("Scale");
  EXPECT_EQ(JsonOfFields(row.fields(), row.example_params.get()).dump(), R"({"factor":4})");
  EXPECT_EQ(JsonOfFields(row.fields(), row.new_params().get()).dump(), R"({"factor":2})");
  EXPECT_EQ(row.MakeExample({})->outputs().front().name, "out");
}

TEST(CatalogueTest, ACallableThatMakesNothingIsToldOf) {
  Catalogue catalogue;
  catalogue.Add("Nothing", kNormDoc, []() -> std::unique_ptr<System> { return nullptr; });
  const CatalogueRow& row = *catalogue.Find("Nothing");
  const auto made_nothing =
      ThrowsMessage<ConfigError>(HasSubstr("'Nothing': made nothing; expected a system"));
  EXPECT_THAT([&] { row.MakeExample({}); }, made_nothing);
  Problems problems;
  EXPECT_EQ(row.Make(Value(Value::Map{}, {}), "systems.x", {}, problems), nullptr);
  EXPECT_THAT([&] { problems.Throw(); },
              ThrowsMessage<ConfigError>(HasSubstr("systems.x: catalogue: type 'Nothing'")));
}

TEST(CatalogueTest, AnExampleIsWhatItsFieldsSay) {
  Catalogue catalogue;
  catalogue.Add("Scale", kNormDoc, Foreign::Params{-1.0},
                [](const Foreign::Params&) { return MakeNorm(); });
  EXPECT_THAT([&] { catalogue.Find("Scale")->MakeExample({}); },
              ThrowsMessage<ConfigError>(HasSubstr("'Scale': example; got factor: got -1")));
}

TEST(CatalogueTest, ARowReadsParametersAndMakesAnyNumberOfSystemsOfThem) {
  auto catalogue = Catalogue();
  catalogue.Add<Foreign>("Foreign");
  const CatalogueRow& row = *catalogue.Find("Foreign");
  const auto given = [](double factor) {
    return Value(Value::Map{{"factor", {}, Value(factor, {})}}, {});
  };
  Problems problems;
  const auto params = row.Read(given(4.0), "systems.x", problems);
  EXPECT_EQ(JsonOfFields(row.fields(), params.get()).dump(), R"({"factor":4})");
  const auto one = row.Make(params.get(), given(4.0), "systems.x", {}, problems);
  EXPECT_NE(one, row.Make(params.get(), given(4.0), "systems.x", {}, problems));
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(row.Read(given(-1.0), "systems.x", problems), nullptr);
  const auto unlucky = row.Read(given(13.0), "systems.x", problems);
  EXPECT_EQ(row.Make(unlucky.get(), given(13.0), "systems.x", {}, problems), nullptr);
  ASSERT_EQ(problems.all().size(), 2u);
  EXPECT_THAT(problems.all()[0].ToString(), HasSubstr("systems.x.factor: got -1"));
  EXPECT_THAT(problems.all()[1].ToString(), HasSubstr("systems.x: brings bad luck"));
}

class ForeignFileTest : public testing::Test {
 protected:
  loading::LoadedDiagram Load(const std::string& systems, const Catalogue& catalogue) {
    return loading::LoadDiagram(
        folder_.Write("d.yaml", "simulator: {duration: 1}\nsystems:\n" + systems), {}, catalogue);
  }
  static Catalogue Mine() {
    auto catalogue = Catalogue::Standard();
    catalogue.Add<Foreign>("Foreign").Add("Norm", kNormDoc, MakeNorm);
    return catalogue;
  }
  test::TemporaryFolder folder_;
};

TEST_F(ForeignFileTest, RunsWithTheirOwnCatalogueAndNoOther) {
  const std::string systems =
      "  source: {type: Constant, value: [3, 4]}\n"
      "  norm: {type: Norm}\n"
      "  foreign: {type: Foreign, factor: 10}\n"
      "connections: [source.value -> norm.in, norm.out -> foreign.in]\n"
      "expect: {'foreign.out': {equal: 50}}\n";
  // The diagram outlives the catalogue that it was made with.
  const loading::LoadedDiagram loaded = Load(systems, Mine());
  EXPECT_TRUE(runs::Run(loaded, {}).ExpectationsMet());
  EXPECT_EQ(loaded.systems[2].row->type, "Foreign");
  EXPECT_THAT([&] { Load(systems, Catalogue::Standard()); },
              ThrowsMessage<ConfigError>(AllOf(HasSubstr("no system type 'Norm'"),
                                               HasSubstr("no system type 'Foreign'"))));
}

TEST_F(ForeignFileTest, LocatesWhatIsWrongWithAForeignParameter) {
  EXPECT_THAT([&] { Load("  foreign: {type: Foreign, factor: -1}\n", Mine()); },
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("d.yaml:3:"), HasSubstr("systems.foreign.factor: got -1"))));
  EXPECT_THAT([&] { Load("  foreign: {type: Foreign, factor: 13}\n", Mine()); },
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("d.yaml:3:"), HasSubstr("systems.foreign: brings bad luck"))));
}

TEST_F(ForeignFileTest, PartsAndMovableDiagramsTakeItToo) {
  const auto file = folder_.Write("e.yaml",
                                  "systems:\n"
                                  "  source: {type: Constant, value: 3}\n"
                                  "  foreign: {type: Foreign}\n"
                                  "connections: [source.value -> foreign.in]\n");
  const loading::Blueprint blueprint(file, Mine());
  EXPECT_EQ(blueprint.Build({}, {.movable = true}).systems.size(), 2u);
  const loading::LoadedDiagram part =
      blueprint.Build({}, {.part = std::vector<std::string>{"foreign"}});
  EXPECT_EQ(part.diagram->inputs().front().name, "source.value");
}

}  // namespace catalogue_test
}  // namespace oca::files
