// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/request_ahead.h"

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/config_errors.h"
#include "oca/systems/signals/json_fields.h"

namespace oca {

using systems::Json;
using systems::JsonReader;
using systems::RequestAhead;

void Signal<RequestAhead>::WriteJson(const RequestAhead& value, std::string& out) {
  static constexpr const char* kKeys[] = {"position", "velocity", "acceleration"};
  Json points = Json::array();
  if (value.trajectory) {
    for (const double time : value.trajectory->times()) {
      Json point = {{"time", time}};
      for (int d = 0; d < 3; ++d) {
        const Eigen::VectorXd x = value.trajectory->Evaluate(time, d);
        point[kKeys[d]] = std::vector<double>(x.begin(), x.end());
      }
      points.push_back(std::move(point));
    }
  }
  out += oca::internal::JsonText(Json{{"points", std::move(points)}});
}

RequestAhead Signal<RequestAhead>::ReadJson(std::string_view text) {
  const Json json = oca::internal::ReadJsonTree(text);
  const JsonReader reader(json, "ahead");
  reader.CheckKeys({"points"});
  std::vector<motion::KeyPoint> points;
  const auto vector = [](const JsonReader& item) {
    std::vector<double> numbers;
    item.ForEach([&](const JsonReader& number) { numbers.push_back(number.Number()); });
    return Eigen::VectorXd(
        Eigen::Map<Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size())));
  };
  reader.At("points").ForEach([&](const JsonReader& item) {
    item.CheckKeys({"time", "position", "velocity", "acceleration"});
    points.push_back({item.At("time").Number(), vector(item.At("position")),
                      vector(item.At("velocity")), vector(item.At("acceleration"))});
  });
  if (points.empty()) return {};
  const auto n = points.front().position.size();
  for (const motion::KeyPoint& point : points) {
    if (point.position.size() != n || point.velocity->size() != n ||
        point.acceleration->size() != n) {
      throw ConfigError("ahead.points: lengths differ; got several; expected one");
    }
  }
  systems::WithConfigErrors([&] { motion::CheckKeyPoints(points, "ahead.points"); });
  return {std::make_shared<const motion::Trajectory>(motion::Trajectory::QuinticHermite(points))};
}

}  // namespace oca
