// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/files/yaml_text.h"
#include "tests/temporary_folder.h"

namespace oca::files {
namespace document_test {

using testing::HasSubstr;

/// The merged files under the overrides.
Value LoadUnder(const std::filesystem::path& file, const std::vector<Override>& overrides,
                Problems& problems) {
  Value root = LoadFiles(file, overrides, problems).root;
  if (problems.empty()) ApplyOverrides(overrides, root, problems);
  return root;
}

class DocumentTest : public testing::Test {
 protected:
  /// Loads `main.yaml` of the folder; the problems go to `problems`.
  Value Load(const std::vector<std::string>& overrides = {}) {
    std::vector<Override> parsed;
    for (const std::string& text : overrides) parsed.push_back(Override::Parse(text));
    Problems found;
    Value value = LoadUnder(folder.path() / "main.yaml", parsed, found);
    problems.clear();
    for (const Diagnostic& problem : found.all()) problems += problem.ToString() + "\n";
    return value;
  }
  std::string ProblemOf(const std::string& override_text) {
    Load({override_text});
    return problems;
  }
  test::TemporaryFolder folder;
  std::string problems;
};

TEST_F(DocumentTest, MapsAreMergedDeepAndThisFileWins) {
  folder.Write("base.yaml",
               "systems: {a: {type: Gain, gain: 1, unit: rad}, b: {type: Sum}}\nname: base\n");
  folder.Write("main.yaml",
               "include: [base.yaml]\nsystems: {a: {gain: 2}, c: {type: Delay}}\nname: main\n");
  const Value value = Load();
  EXPECT_EQ(problems, "");
  EXPECT_EQ(*At(value, "name").string(), "main");
  EXPECT_EQ(*At(value, "systems", "a", "type").string(), "Gain");
  EXPECT_EQ(*At(value, "systems", "a", "gain").integer(), 2);
  EXPECT_EQ(*At(value, "systems", "a", "unit").string(), "rad");
  EXPECT_EQ(*At(value, "systems", "b", "type").string(), "Sum");
  EXPECT_EQ(*At(value, "systems", "c", "type").string(), "Delay");
  EXPECT_TRUE(At(value, "include").null());
}

TEST_F(DocumentTest, ThisFileWinsWhereverItsIncludeStands) {
  folder.Write("base.yaml", "name: base\n");
  folder.Write("main.yaml", "name: main\ninclude: [base.yaml]\n");
  EXPECT_EQ(*At(Load(), "name").string(), "main");
}

TEST_F(DocumentTest, AParameterMayChooseTheFileToInclude) {
  folder.Write("part_one.yaml", "name: one\n");
  folder.Write("part_two.yaml", "name: two\n");
  folder.Write("choice.yaml", "include: ['part_${method}.yaml']\nparameters: {method: one}\n");
  folder.Write("main.yaml", "include: [choice.yaml]\n");
  EXPECT_EQ(*At(Load(), "name").string(), "one");
  EXPECT_EQ(*At(Load({"parameters.method=two"}), "name").string(), "two");
  EXPECT_EQ(*At(Load({"parameters.method=one", "parameters.method=two"}), "name").string(), "two");
  folder.Write("main.yaml", "include: [choice.yaml]\nparameters: {method: two}\n");
  EXPECT_EQ(*At(Load(), "name").string(), "two");
  EXPECT_EQ(*At(Load({"parameters.method=one"}), "name").string(), "one");
  EXPECT_EQ(*At(Load(), "parameters", "method").string(), "two");
  EXPECT_EQ(problems, "");
}

TEST_F(DocumentTest, WhatComesWithOcaIsIncludedFromAnywhere) {
  folder.Write("main.yaml",
               "include: ['package://oca/parts/avoidance_${method}.yaml']\n"
               "parameters: {method: safety_filter}\n");
  const Value value = Load();
  EXPECT_EQ(problems, "");
  EXPECT_EQ(*At(value, "systems", "filter", "type").string(), "SafetyFilter");
  EXPECT_EQ(*At(value, "systems", "overlay", "type").string(), "DeltaOverlay");
  folder.Write("main.yaml", "include: [package://nowhere/loop.yaml]\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("main.yaml:1:11: error: include: package://nowhere/loop.yaml: no "
                                  "package 'nowhere'"));
}

TEST_F(DocumentTest, AFileNameRefusesAParameterThatIsNoText) {
  folder.Write("main.yaml", "include: ['part_${metod}.yaml']\nparameters: {method: one, n: 2}\n");
  Load();
  EXPECT_THAT(problems,
              HasSubstr("main.yaml:1:11: error: include: part_${metod}.yaml: no parameter "
                        "'metod' that is a text; did you mean 'method'?"));
  folder.Write("main.yaml", "include: ['part_${n}.yaml']\nparameters: {n: 2}\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("no parameter 'n' that is a text"));
  folder.Write("main.yaml", "include: ['part_${n']\nparameters: {n: two}\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("got 'part_${n'; expected a '}' after '${'"));
}

TEST_F(DocumentTest, ListsAreReplacedButConnectionsAppended) {
  folder.Write("base.yaml", "x: {list: [1, 2, 3]}\nconnections: [a.out -> b.in]\n");
  folder.Write("main.yaml", "include: [base.yaml]\nx: {list: [4]}\nconnections: [b.out -> c.in]\n");
  const Value value = Load();
  ASSERT_EQ(At(value, "x", "list").list()->size(), 1u);
  EXPECT_EQ(*At(value, "x", "list").list()->front().integer(), 4);
  ASSERT_EQ(At(value, "connections").list()->size(), 2u);
  EXPECT_EQ(*At(value, "connections").list()->at(0).string(), "a.out -> b.in");
  EXPECT_EQ(*At(value, "connections").list()->at(1).string(), "b.out -> c.in");
}

TEST_F(DocumentTest, ALaterIncludeWinsOverAnEarlierOne) {
  folder.Write("one.yaml", "x: 1\ny: 1\n");
  folder.Write("two.yaml", "x: 2\n");
  folder.Write("main.yaml", "include: [one.yaml, two.yaml]\n");
  EXPECT_EQ(*At(Load(), "x").integer(), 2);
  EXPECT_EQ(*At(Load(), "y").integer(), 1);
}

TEST_F(DocumentTest, IncludesNestRelativeToTheFileThatNamesThem) {
  folder.Write("parts/deep/leaf.yaml", "leaf: 1\n");
  folder.Write("parts/middle.yaml", "include: [deep/leaf.yaml]\nmiddle: 2\n");
  folder.Write("main.yaml", "include: [parts/middle.yaml]\n");
  const Value value = Load();
  EXPECT_EQ(problems, "");
  EXPECT_EQ(*At(value, "leaf").integer(), 1);
  EXPECT_THAT(At(value, "leaf").location().ToString(), HasSubstr("parts/deep/leaf.yaml:1:7"));
}

TEST_F(DocumentTest, AFileIncludedTwiceConnectsOnce) {
  folder.Write("base.yaml", "connections: [a.out -> b.in]\n");
  folder.Write("left.yaml", "include: [base.yaml]\n");
  folder.Write("right.yaml", "include: [base.yaml]\n");
  folder.Write("main.yaml", "include: [left.yaml, right.yaml]\n");
  EXPECT_EQ(At(Load(), "connections").list()->size(), 1u);
}

TEST_F(DocumentTest, CirclesOfIncludesAreRefusedAtTheirPlace) {
  folder.Write("other.yaml", "x: 1\ninclude: [main.yaml]\n");
  folder.Write("main.yaml", "include: [other.yaml]\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("other.yaml:2:11: error: include: "));
  EXPECT_THAT(problems, HasSubstr("includes itself"));
  folder.Write("main.yaml", "include: [./main.yaml]\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("includes itself"));
}

TEST_F(DocumentTest, PlacesInAnIncludedFileAreToldWithoutTheWayThere) {
  folder.Write("parts/base.yaml", "name: base\ninclude: [../other/../parts/more.yaml]\n");
  folder.Write("parts/more.yaml", "description: more\n");
  folder.Write("scenarios/this.yaml", "include: [../parts/base.yaml]\n");
  Problems found;
  const Value value = LoadFiles(folder.path() / "scenarios/this.yaml", {}, found).root;
  EXPECT_EQ(At(value, "name").location().ToString(),
            (folder.path() / "parts/base.yaml").string() + ":1:7");
  // A folder that is not there leads nowhere, however the name would read without it.
  ASSERT_EQ(found.all().size(), 1u);
  EXPECT_THAT(found.all()[0].ToString(), HasSubstr("parts/../other/../parts/more.yaml"));
}

TEST_F(DocumentTest, ALinkOnTheWayToAnIncludedFileIsFollowed) {
  folder.Write("deep/inside/this.yaml", "");
  folder.Write("deep/part.yaml", "name: deep\n");
  folder.Write("part.yaml", "name: shallow\n");
  std::filesystem::create_directory_symlink("deep/inside", folder.path() / "linked");
  folder.Write("main.yaml", "include: [linked/../part.yaml]\n");
  EXPECT_EQ(*At(Load(), "name").string(), "deep");
  EXPECT_EQ(problems, "");
}

TEST_F(DocumentTest, AnEmptyNameOfAFileIsRefusedWhereItStands) {
  Problems found;
  EXPECT_THAT(
      [&] { LoadFiles("", {}, found); },
      testing::ThrowsMessage<ConfigError>("diagram: got an empty file name; expected a path"));
  folder.Write("main.yaml", "include: ['']\nname: main\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("main.yaml:1:11: error: include: got ''; expected a file name"));
}

TEST_F(DocumentTest, WrongIncludesAreRefused) {
  folder.Write("list.yaml", "- 1\n");
  folder.Write("main.yaml", "include: [missing.yaml]\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("main.yaml:1:11: error: include: "));
  EXPECT_THAT(problems, HasSubstr("missing.yaml: error: cannot be read"));
  folder.Write("method_one.yaml", "");
  folder.Write("method_two.yaml", "");
  folder.Write("main.yaml", "include: [method_tow.yaml]\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("expected one of method_one.yaml, method_two.yaml"));
  folder.Write("main.yaml", "include: list.yaml\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("expected a list of files"));
  folder.Write("main.yaml", "include: [3]\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("got 3; expected a file name"));
  folder.Write("main.yaml", "include: [list.yaml]\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("list.yaml: got a list; expected a map"));
}

TEST_F(DocumentTest, AFileThatHoldsNoMapIsRefused) {
  folder.Write("main.yaml", "# nothing\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("main.yaml:1:1: error: is empty; expected a map with systems"));
  folder.Write("main.yaml", "- 1\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("got a list; expected a map with systems"));
  EXPECT_THROW(LoadFiles(folder.path() / "none.yaml", {}, *std::make_unique<Problems>()),
               ConfigError);
}

class OverrideTest : public DocumentTest {
 protected:
  void SetUp() override {
    folder.Write("base.yaml", "parameters: {alpha: 1, beta: 1, gamma: 1}\n");
    folder.Write("main.yaml",
                 "include: [base.yaml]\n"
                 "parameters: {beta: 2, gamma: 2}\n"
                 "models: {arm: {urdf: a.urdf}}\n"
                 "systems:\n"
                 "  limiter: {type: DeltaLimiter, max_joint_velocity: 0.6}\n"
                 "  obstacles:\n"
                 "    type: ObstacleSource\n"
                 "    obstacles: [{id: a, pose: {xyz: [1, 2, 3]}}, {id: b}]\n"
                 "record: {signals: {plant.position: 100}}\n"
                 "expect: {min_distance: {at_least: 0.2}}\n");
  }
};

TEST_F(OverrideTest, PrecedenceIsIncludeThenFileThenOption) {
  const Value value = Load({"parameters.gamma=3"});
  EXPECT_EQ(*At(value, "parameters", "alpha").integer(), 1);
  EXPECT_EQ(*At(value, "parameters", "beta").integer(), 2);
  EXPECT_EQ(*At(value, "parameters", "gamma").integer(), 3);
}

TEST_F(OverrideTest, TheLastOfEqualOptionsWins) {
  EXPECT_EQ(*At(Load({"parameters.beta=7", "parameters.beta=8"}), "parameters", "beta").integer(),
            8);
}

TEST_F(OverrideTest, TheValueIsYaml) {
  EXPECT_TRUE(*At(Load({"parameters.beta=true"}), "parameters", "beta").boolean());
  EXPECT_EQ(*At(Load({"parameters.beta='4'"}), "parameters", "beta").string(), "4");
  EXPECT_EQ(*At(Load({"parameters.beta=a=b"}), "parameters", "beta").string(), "a=b");
  EXPECT_EQ(At(Load({"parameters.beta=[1, 2]"}), "parameters", "beta").list()->size(), 2u);
  EXPECT_EQ(*At(Load({"parameters.beta={k: 1}"}), "parameters", "beta", "k").integer(), 1);
}

TEST_F(OverrideTest, ListItemsAreReachedByIndex) {
  const Value value = Load({"systems.obstacles.obstacles.0.pose.xyz.1=-5"});
  EXPECT_EQ(problems, "");
  const Value xyz = At(At(value, "systems", "obstacles", "obstacles").list()->at(0), "pose", "xyz");
  EXPECT_EQ(*xyz.list()->at(0).integer(), 1);
  EXPECT_EQ(*xyz.list()->at(1).integer(), -5);
  for (const char* index : {"2", "-1", "x", "0x", ""}) {
    EXPECT_THAT(ProblemOf("systems.obstacles.obstacles." + std::string(index) + "=1"),
                HasSubstr("expected an index below 2"))
        << index;
  }
}

TEST_F(OverrideTest, ADefaultThatTheFileDoesNotGiveCanBeSet) {
  EXPECT_FALSE(
      *At(Load({"systems.limiter.enabled=false"}), "systems", "limiter", "enabled").boolean());
  EXPECT_EQ(*At(Load({"simulator.duration=3"}), "simulator", "duration").integer(), 3);
  EXPECT_EQ(At(Load({"models.arm.base_pose.xyz=[0, 0, 1]"}), "models", "arm", "base_pose", "xyz")
                .list()
                ->size(),
            3u);
  EXPECT_EQ(problems, "");
}

TEST_F(OverrideTest, KeysThatHoldDotsAreReached) {
  const Value value = Load({"record.signals.plant.position=50"});
  EXPECT_EQ(problems, "");
  EXPECT_EQ(*At(value, "record", "signals", "plant.position").integer(), 50);
}

TEST_F(OverrideTest, AnUnknownPathNamesTheNearest) {
  EXPECT_THAT(ProblemOf("parameters.alhpa=1"),
              HasSubstr("-s parameters.alhpa: error: no 'alhpa' there; did you mean 'alpha'?"));
  EXPECT_THAT(ProblemOf("systems.limitr.enabled=1"), HasSubstr("did you mean 'limiter'?"));
  EXPECT_THAT(ProblemOf("models.arn.urdf=x"), HasSubstr("did you mean 'arm'?"));
  EXPECT_THAT(ProblemOf("paramters.alpha=1"), HasSubstr("did you mean 'parameters'?"));
  EXPECT_THAT(ProblemOf("simulater.duration=1"), HasSubstr("did you mean 'simulator'?"));
  EXPECT_THAT(ProblemOf("alpha.x=1"),
              HasSubstr("no 'alpha' there; did you mean 'parameters.alpha'?"));
  EXPECT_THAT(ProblemOf("limiter.enabled=1"), HasSubstr("did you mean 'systems.limiter'?"));
  EXPECT_THAT(ProblemOf("arm.urdf=x"), HasSubstr("did you mean 'models.arm'?"));
  EXPECT_THAT(ProblemOf("limitr.enabled=1"), HasSubstr("did you mean 'systems.limiter'?"));
  EXPECT_THAT(ProblemOf("zzz=1"), HasSubstr("no 'zzz' there; expected one of name, description, "));
  EXPECT_THAT(ProblemOf("systems.limiter.type.x=1"), HasSubstr("expected a key of a map"));
  EXPECT_THAT(ProblemOf("parameters..alpha=1"), HasSubstr("error"));
}

TEST_F(OverrideTest, IncludesCannotBeSet) {
  EXPECT_THAT(ProblemOf("include=[other.yaml]"), HasSubstr("include: cannot be overridden"));
}

TEST_F(OverrideTest, AWrongValueSaysWhy) {
  EXPECT_THAT(ProblemOf("parameters.beta=no"), HasSubstr("expected true or false"));
  EXPECT_THAT(ProblemOf("parameters.beta=\"open"), HasSubstr("error: "));
  EXPECT_THAT(ProblemOf("parameters.beta=[1"), HasSubstr("-s parameters.beta"));
  EXPECT_THAT(ProblemOf("parameters.beta="), HasSubstr("got ''; expected a YAML value"));
}

TEST_F(OverrideTest, WhatIsNoPathAndValueIsRefused) {
  for (const char* text : {"", "parameters.beta", "=3"}) {
    EXPECT_THROW(Override::Parse(text), ConfigError) << text;
  }
  const Override parsed = Override::Parse("a.b=c=d");
  EXPECT_EQ(parsed.path, "a.b");
  EXPECT_EQ(parsed.value, "c=d");
}

TEST_F(DocumentTest, FilesThatIncludeOneAnotherTwiceEachAreRefusedQuickly) {
  folder.Write("main.yaml", "include: [i0.yaml]\n");
  for (int i = 0; i < 30; ++i) {
    const std::string next = "i" + std::to_string(i + 1) + ".yaml";
    folder.Write("i" + std::to_string(i) + ".yaml", "include: [" + next + ", " + next + "]\n");
  }
  folder.Write("i30.yaml", "name: end\n");
  Load();
  EXPECT_THAT(problems, HasSubstr("include: more than 200 files"));
}

}  // namespace document_test
}  // namespace oca::files
