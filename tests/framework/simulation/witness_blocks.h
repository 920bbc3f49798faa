// SPDX-License-Identifier: BSD-3-Clause
// Systems with witnesses, whose crossings are known exactly.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/diagram.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace witness_test {

using blocks::Vec;

/// h'' = -g; at h = 0, falling, v+ = -e v. The state is (h, v).
class Ball final : public System {
 public:
  explicit Ball(double restitution = 0.8, Direction direction = Direction::kFalling)
      : restitution_(restitution),
        x(DeclareContinuousState("x", {2}, Vec({1.0, 0.0}))),
        out(DeclareStateOutput("out", x)) {
    DeclareDerivative<&Ball::Derive>(x, x);
    const Witness ground = DeclareWitness<&Ball::Height>("ground", direction, x);
    DeclareReset<&Ball::Bounce>(When{ground}, Writes(x), kTime, x);
  }
  mutable std::vector<double> bounces;  // s
  bool remember{true};

 private:
  static constexpr double kGravity = 9.81;
  void Derive(VectorView now, MutableVectorView derivative) const {
    derivative << now[1], -kGravity;
  }
  double Height(VectorView now) const { return now[0]; }
  void Bounce(double t, VectorView now, MutableVectorView next) const {
    if (remember) bounces.push_back(t);
    next[1] = -restitution_ * now[1];
  }
  const double restitution_;

 public:
  const ContinuousState x;
  const Output<Vector> out;
};

/// tau x' = (hot or cold) - x; switches the heater off at 21 and on at 19.
class Thermostat final : public System {
 public:
  Thermostat()
      : x(DeclareContinuousState("x", {1}, 20.0)),
        on(DeclareDiscreteState("on", {1}, 1.0)),
        out(DeclareStateOutput("out", x)) {
    DeclareDerivative<&Thermostat::Derive>(x, x, on);
    const Witness warm = DeclareWitness<&Thermostat::OverUpper>("warm", Direction::kRising, x);
    const Witness cool = DeclareWitness<&Thermostat::OverLower>("cool", Direction::kFalling, x);
    DeclareReset<&Thermostat::SwitchOff>(When{warm}, Writes(on), kTime);
    DeclareReset<&Thermostat::SwitchOn>(When{cool}, Writes(on), kTime);
  }
  mutable std::vector<double> switches;  // s

 private:
  void Derive(VectorView now, VectorView heats, MutableVectorView derivative) const {
    derivative[0] = ((heats[0] > 0.5 ? 30.0 : 15.0) - now[0]) / 10.0;
  }
  double OverUpper(VectorView now) const { return now[0] - 21.0; }
  double OverLower(VectorView now) const { return now[0] - 19.0; }
  void SwitchOff(double t, MutableVectorView next) const {
    switches.push_back(t);
    next[0] = 0.0;
  }
  void SwitchOn(double t, MutableVectorView next) const {
    switches.push_back(t);
    next[0] = 1.0;
  }

 public:
  const ContinuousState x;
  const DiscreteState<Vector> on;
  const Output<Vector> out;
};

/// Notes when f(t, in) crosses zero, and counts it in a state.
class Alarm final : public System {
 public:
  using Function = std::function<double(double, double)>;
  explicit Alarm(Function f, Direction direction = Direction::kBoth)
      : f_(std::move(f)),
        count(DeclareDiscreteState("count", {1}, 0.0)),
        in(DeclareInput<Vector>("in", {1})),
        out(DeclareStateOutput("out", count)) {
    const Witness level = DeclareWitness<&Alarm::Level>("level", direction, kTime, in);
    DeclareReset<&Alarm::Note>(When{level}, Writes(count), kTime, count);
  }
  mutable std::vector<double> times;  // s

 private:
  double Level(double t, VectorView value) const { return f_(t, value[0]); }
  void Note(double t, VectorView now, MutableVectorView next) const {
    times.push_back(t);
    next[0] = now[0] + 1.0;
  }
  const Function f_;

 public:
  const DiscreteState<Vector> count;
  const Input<Vector> in;
  const Output<Vector> out;
};

/// x' = 1 from 0, watched by an alarm.
struct Watched {
  explicit Watched(Alarm::Function f, Direction direction = Direction::kBoth) {
    DiagramBuilder builder;
    const auto& one = builder.Add<blocks::Source>("one", Vec({1.0}));
    const auto& ode =
        builder.Add<blocks::Ode>("ode", 0.0, [](double, double, double u) { return u; });
    alarm = &builder.Add<Alarm>("alarm", std::move(f), direction);
    builder.Connect(one.value, ode.in);
    builder.Connect(ode.out, alarm->in);
    diagram = builder.Build();
  }
  const Alarm* alarm;
  std::unique_ptr<Diagram> diagram;
};

/// Two witnesses with one zero; each adds the other's count to its own.
class Twins final : public System {
 public:
  explicit Twins(double apart)
      : apart_(apart),
        a(DeclareDiscreteState("a", {1}, 1.0)),
        b(DeclareDiscreteState("b", {1}, 10.0)),
        x(DeclareContinuousState("x", {1}, 0.0)) {
    DeclareDerivative<&Twins::Derive>(x);
    const Witness one = DeclareWitness<&Twins::One>("one", Direction::kBoth, x);
    const Witness other = DeclareWitness<&Twins::Other>("other", Direction::kBoth, x);
    DeclareReset<&Twins::Take>(When{one}, Writes(a), b);
    DeclareReset<&Twins::Take>(When{other}, Writes(b), a);
  }

 private:
  void Derive(MutableVectorView derivative) const { derivative[0] = 1.0; }
  double One(VectorView now) const { return now[0] - 0.3; }
  double Other(VectorView now) const { return 2.0 * (0.3 + apart_ - now[0]); }
  void Take(VectorView from, MutableVectorView to) const { to[0] = from[0]; }
  const double apart_;

 public:
  const DiscreteState<Vector> a, b;
  const ContinuousState x;
};

}  // namespace witness_test
}  // namespace oca
