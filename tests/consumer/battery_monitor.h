// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <oca/framework/dataflow/json_object.h>
#include <oca/framework/dataflow/params.h>
#include <oca/framework/dataflow/system.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace acme {

/// What is left in the battery of a mobile arm.
struct Battery {
  double charge{1.0};  ///< share of the capacity
  double power{0.0};   ///< W, that is drawn
  bool low{false};
};

}  // namespace acme

// A type that ports carry: its name, what its values may be, and its JSON.
template <>
struct oca::Signal<acme::Battery> {
  static constexpr const char* kName = "Battery";

  static Fault Check(const acme::Battery& battery, Look look) {
    const double numbers[] = {battery.charge, battery.power};
    if (!AllFinite(numbers, 2)) return Fault::UnlessFinite(false);
    if (look == Look::kWhole && (battery.charge < 0.0 || battery.charge > 1.0)) {
      return Fault("charge; got " + std::to_string(battery.charge) + "; expected 0 to 1");
    }
    return {};
  }
  static void WriteJson(const acme::Battery& battery, std::string& out) {
    oca::JsonObject(out)
        .Number("charge", battery.charge)
        .Number("power", battery.power)
        .Flag("low", battery.low);
  }
  static acme::Battery ReadJson(std::string_view text) {
    const oca::JsonMembers json(text, {"charge", "power", "low"});
    return {json.Number("charge"), json.Number("power"), json.Flag("low")};
  }
};

namespace acme {

/// Counts what the joints take out of the battery.
///
///     power = idle_power + joint_power sum_i |velocity_i|
///     charge[k + 1] = max(0, charge[k] - power period / capacity),   low if charge < low_charge
///
/// in    velocity  n        rad/s
/// out   power     1        W
/// out   battery   Battery
/// state battery
class BatteryMonitor final : public oca::System {
 public:
  static constexpr oca::SystemDoc kDoc{
      "counts what the joints take out of the battery",
      "charge' = max(0, charge - power period / capacity), power = idle_power + joint_power |v|_1",
      "data sheet of the ACME 7"};

  struct Params {
    double capacity{0.0};
    double idle_power{20.0};
    double joint_power{50.0};
    double low_charge{0.2};
    oca::Period period{1, 100};
    static void Describe(oca::Fields<Params>& fields) {
      fields.Add("capacity", &Params::capacity, "J", "energy of the full battery")
          .Above(0.0)
          .Required();
      fields.Add("idle_power", &Params::idle_power, "W", "drawn at rest").AtLeast(0.0);
      fields.Add("joint_power", &Params::joint_power, "W s/rad", "more for each rad/s of a joint")
          .AtLeast(0.0);
      fields.Add("low_charge", &Params::low_charge, "", "share below which the battery is low")
          .AtLeast(0.0)
          .AtMost(1.0);
      fields.Add("period", &Params::period, "s", "time between two counts").Above(0.0);
    }
  };
  static Params Example() { return {.capacity = 1000.0}; }

  explicit BatteryMonitor(const Params& params)
      : params_(params),
        size_(DeclareSize()),
        state_(DeclareDiscreteState<Battery>("battery", {.power = params.idle_power})),
        velocity(DeclareInput<oca::Vector>("velocity", {size_, "rad/s"})),
        power(DeclareOutput<oca::Vector, &BatteryMonitor::CalcPower>("power", {1, "W"}, velocity)),
        battery(DeclareStateOutput("battery", state_)) {
    DeclareUpdate<&BatteryMonitor::Count>({params_.period}, oca::Writes(state_), power);
  }

 private:
  void CalcPower(oca::VectorView v, oca::MutableVectorView watt) const {
    watt[0] = params_.idle_power + params_.joint_power * v.lpNorm<1>();
  }
  void Count(oca::VectorView watt, Battery& next) const {
    next.power = watt[0];
    next.charge -= next.power * params_.period.seconds() / params_.capacity;
    next.charge = std::max(0.0, next.charge);
    next.low = next.charge < params_.low_charge;
  }

  const Params params_;
  const oca::Size size_;
  const oca::DiscreteState<Battery> state_;

 public:
  const oca::Input<oca::Vector> velocity;
  const oca::Output<oca::Vector> power;
  const oca::Output<Battery> battery;
};

}  // namespace acme
