// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <atomic>
#include <functional>
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/dataflow/system.h"

// Small systems that the tests of the framework wire together.

namespace oca {

/// A signal that is no vector.
struct Label {
  std::string text{"unset"};
};
template <>
struct Signal<Label> {
  static constexpr const char* kName = "Label";
  static Fault Check(const Label& label, Look /*look*/) {
    return Fault::UnlessFinite(label.text != "nan");
  }
  static void WriteJson(const Label& label, std::string& out) { out += '"' + label.text + '"'; }
  static Label ReadJson(std::string_view text) { return {std::string(text)}; }
};

namespace blocks {

inline Eigen::VectorXd Vec(std::initializer_list<double> values) {
  Eigen::VectorXd vector(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), vector.data());
  return vector;
}

/// value = a constant that reads nothing.
class Source final : public System {
 public:
  explicit Source(Eigen::VectorXd constant, const Unit& unit = Unit::Any())
      : constant_(std::move(constant)),
        value(DeclareOutput<Vector, &Source::Calc>("value",
                                                   {static_cast<int>(constant_.size()), unit})) {}
  mutable std::atomic<int> calls{0};

 private:
  const Eigen::VectorXd constant_;
  void Calc(MutableVectorView out) const {
    ++calls;
    out = constant_;
  }

 public:
  const Output<Vector> value;
};

/// value = f(t)
class Clock final : public System {
 public:
  explicit Clock(std::function<double(double)> f = [](double t) { return t; })
      : f_(std::move(f)), value(DeclareOutput<Vector, &Clock::Calc>("value", {1}, kTime)) {}
  mutable std::atomic<int> calls{0};

 private:
  const std::function<double(double)> f_;
  void Calc(double t, MutableVectorView out) const {
    ++calls;
    out[0] = f_(t);
  }

 public:
  const Output<Vector> value;
};

/// out_i = f(in_i); keeps length and unit.
class Map final : public System {
 public:
  using Function = std::function<double(double)>;
  explicit Map(Function f = [](double x) { return x; })
      : f_(std::move(f)),
        size_(DeclareSize()),
        unit_(DeclareUnit()),
        in(DeclareInput<Vector>("in", {size_, unit_})),
        out(DeclareOutput<Vector, &Map::Calc>("out", {size_, unit_}, in)) {}
  mutable std::atomic<int> calls{0};

 private:
  const Function f_;
  const Size size_;
  const Unit unit_;
  void Calc(VectorView x, MutableVectorView y) const {
    ++calls;
    for (Eigen::Index i = 0; i < x.size(); ++i) y[i] = f_(x[i]);
  }

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

/// out = in0 + in1
class Sum final : public System {
 public:
  Sum()
      : size_(DeclareSize()),
        unit_(DeclareUnit()),
        in0(DeclareInput<Vector>("in0", {size_, unit_})),
        in1(DeclareInput<Vector>("in1", {size_, unit_})),
        out(DeclareOutput<Vector, &Sum::Calc>("out", {size_, unit_}, in0, in1)) {}

 private:
  const Size size_;
  const Unit unit_;
  void Calc(VectorView a, VectorView b, MutableVectorView sum) const { sum = a + b; }

 public:
  const Input<Vector> in0, in1;
  const Output<Vector> out;
};

/// An input of a given length and unit that nothing reads.
class Sink final : public System {
 public:
  explicit Sink(int size, const Unit& unit = Unit::Any())
      : in(DeclareInput<Vector>("in", {size, unit})) {}
  const Input<Vector> in;
};

/// state+ = in, every period; out shows the state.
class Delay final : public System {
 public:
  explicit Delay(Every every, PerComponent initial = 0.0)
      : size_(DeclareSize({{"initial", &initial}})),
        unit_(DeclareUnit()),
        state(DeclareDiscreteState("state", {size_, unit_}, initial)),
        in(DeclareInput<Vector>("in", {size_, unit_})),
        out(DeclareStateOutput("out", state)) {
    DeclareUpdate<&Delay::Update>(every, Writes(state), in);
  }

 private:
  const Size size_;
  const Unit unit_;
  void Update(VectorView value, MutableVectorView next) const { next = value; }

 public:
  const DiscreteState<Vector> state;
  const Input<Vector> in;
  const Output<Vector> out;
};

/// count+ = count + 1, every period; remembers when.
class Counter final : public System {
 public:
  explicit Counter(Every every)
      : count(DeclareDiscreteState("count", {1}, 0.0)), value(DeclareStateOutput("value", count)) {
    DeclareUpdate<&Counter::Update>(every, Writes(count), kTime, count);
  }
  mutable std::vector<double> times;
  bool remember{true};

 private:
  void Update(double t, VectorView now, MutableVectorView next) const {
    if (remember) times.push_back(t);
    next[0] = now[0] + 1.0;
  }

 public:
  const DiscreteState<Vector> count;
  const Output<Vector> value;
};

/// x' = f(t, x, in), one component.
class Ode final : public System {
 public:
  using Function = std::function<double(double, double, double)>;
  Ode(double initial, Function f)
      : f_(std::move(f)),
        x(DeclareContinuousState("x", {1}, initial)),
        in(DeclareInput<Vector>("in", {1})),
        out(DeclareStateOutput("out", x)) {
    DeclareDerivative<&Ode::Derive>(x, kTime, x, in);
  }
  mutable std::atomic<int> calls{0};

 private:
  const Function f_;
  void Derive(double t, VectorView now, VectorView u, MutableVectorView derivative) const {
    ++calls;
    derivative[0] = f_(t, now[0], u[0]);
  }

 public:
  const ContinuousState x;
  const Input<Vector> in;
  const Output<Vector> out;
};

/// Calls f(t, in) at publish events.
class Printer final : public System {
 public:
  using Function = std::function<void(double, double)>;
  Printer(Every every, Function f) : f_(std::move(f)), in(DeclareInput<Vector>("in", {1})) {
    DeclarePublish<&Printer::Print>(every, kTime, in);
  }

 private:
  const Function f_;
  void Print(double t, VectorView value) const { f_(t, value[0]); }

 public:
  const Input<Vector> in;
};

/// text = "<in>"; keeps a Label state too, so that objects live in the Context.
class Labeller final : public System {
 public:
  explicit Labeller(Every every)
      : state(DeclareDiscreteState("state", Label{"start"})),
        in(DeclareInput<Vector>("in", {1})),
        text(DeclareOutput<Label, &Labeller::Calc>("text", {}, in)),
        held(DeclareStateOutput("held", state)) {
    DeclareUpdate<&Labeller::Update>(every, Writes(state), text);
  }

 private:
  void Calc(VectorView value, Label& out) const { out.text = std::to_string(value[0]); }
  void Update(const Label& now, Label& next) const { next = now; }

 public:
  const DiscreteState<Label> state;
  const Input<Vector> in;
  const Output<Label> text, held;
};

/// Takes a Label; echoes it.
class LabelSink final : public System {
 public:
  LabelSink()
      : in(DeclareInput<Label>("in")), out(DeclareOutput<Label, &LabelSink::Calc>("out", {}, in)) {}
  const Input<Label> in;

 private:
  void Calc(const Label& from, Label& to) const { to = from; }

 public:
  const Output<Label> out;
};

/// The problems that Build finds; none if it succeeds.
inline std::vector<std::string> ProblemsOf(DiagramBuilder& builder) {
  std::vector<std::string> problems;
  try {
    builder.Build();
  } catch (const WiringError& error) {
    for (const WiringProblem& problem : error.problems) problems.push_back(problem.ToString());
  }
  return problems;
}

}  // namespace blocks
}  // namespace oca
