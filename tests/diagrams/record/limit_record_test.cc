// SPDX-License-Identifier: BSD-3-Clause
// What a record shows of blocks that hold a motion back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>

#include "oca/diagrams/record/series.h"
#include "tests/diagrams/record/record_runs.h"
#include "tests/temporary_folder.h"

namespace oca::record {
namespace limit_record_test {

using nlohmann::json;
using test::Recorded;
using test::RunRecorded;

TEST(LimitRecordTest, ShowsWhenACommandIsCutAndWhenAJointIsAtItsStop) {
  const oca::test::TemporaryFolder folder;
  const auto file =
      folder.Write("d.yaml",
                   "simulator: {duration: 1}\n"
                   "systems:\n"
                   "  wish: {type: SineSource, amplitude: 2, frequency: 1, unit: rad/s}\n"
                   "  cut: {type: Saturation, lower: -1, upper: 1}\n"
                   "  plant: {type: IntegratorPlant, initial_position: [0], upper: 0.1}\n"
                   "connections: [wish.value -> cut.in, cut.out -> plant.command]\n"
                   "record: {signals: {wish.value: 100, plant.position: 100}}\n");
  const Recorded recorded = RunRecorded(loading::LoadDiagram(file));
  const json limits = json::parse(recorded.file.FindMetadata("oca.plots")->at("limits"));
  ASSERT_EQ(limits.size(), 3u);
  const double stop = std::nextafter(0.1, 0.0);
  const std::tuple<const char*, const char*, const char*, double, const char*> expected[] = {
      {"cut", "below", "/wish/value", -1.0, "cut to its bound"},
      {"cut", "above", "/wish/value", 1.0, "cut to its bound"},
      {"plant", "above", "/plant/position", stop, "at its stop"}};
  for (std::size_t i = 0; i < limits.size(); ++i) {
    EXPECT_EQ(std::make_tuple(limits[i]["system"], limits[i]["kind"], limits[i]["signal"],
                              limits[i]["bound"], limits[i]["how"]),
              expected[i]);
  }
  const auto wish = ReadSeries(recorded.file, "wish.value"),
             position = ReadSeries(recorded.file, "plant.position");
  ASSERT_EQ(wish.size(), 1u);
  ASSERT_EQ(position.size(), 1u);
  const auto above = [](const Series& series, double bound) {
    return std::count_if(series.values.begin(), series.values.end(),
                         [bound](double value) { return value > bound; });
  };
  EXPECT_GT(above(wish[0], 1.0), 10);  // a third of the second: 2 sin(2 pi t) > 1
  EXPECT_GT(above(position[0], stop), 10);
  EXPECT_EQ(above(position[0], 0.1), 0);
}

}  // namespace limit_record_test
}  // namespace oca::record
