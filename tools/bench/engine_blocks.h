// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "oca/framework/dataflow/system.h"

namespace oca::bench {

inline constexpr int kWidth = 7;

/// y = 0.999 u + 0.001
class Trivial final : public System {
 public:
  Trivial()
      : in(DeclareInput<Vector>("in", {kWidth})),
        out(DeclareOutput<Vector, &Trivial::Calc>("out", {kWidth}, in)) {}

 private:
  void Calc(VectorView u, MutableVectorView y) const { y = (0.999 * u.array() + 0.001).matrix(); }

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

/// u_i = (i + 1) 0.01 t
class Ramp final : public System {
 public:
  Ramp() : out(DeclareOutput<Vector, &Ramp::Calc>("out", {kWidth}, kTime)) {}

 private:
  void Calc(double t, MutableVectorView u) const {
    for (int i = 0; i < kWidth; ++i) u[i] = (i + 1) * 0.01 * t;
  }

 public:
  const Output<Vector> out;
};

/// x += clamp(u - x, +-1e-3), clamped to +-2.9, every millisecond
class Limiter final : public System {
 public:
  Limiter()
      : x_(DeclareDiscreteState("x", {kWidth}, 0.0)),
        in(DeclareInput<Vector>("in", {kWidth})),
        out(DeclareStateOutput("out", x_)) {
    DeclareUpdate<&Limiter::Update>(Every{Period(1, 1000)}, Writes(x_), in);
  }

 private:
  void Update(VectorView u, MutableVectorView x) const {
    for (int i = 0; i < kWidth; ++i) {
      x[i] = std::clamp(x[i] + std::clamp(u[i] - x[i], -1e-3, 1e-3), -2.9, 2.9);
    }
  }
  const DiscreteState<Vector> x_;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

/// x' = u
class Integrator7 final : public System {
 public:
  Integrator7()
      : x_(DeclareContinuousState("x", {kWidth}, 0.0)),
        in(DeclareInput<Vector>("in", {kWidth})),
        out(DeclareStateOutput("out", x_)) {
    DeclareDerivative<&Integrator7::Derivative>(x_, in);
  }

 private:
  void Derivative(VectorView u, MutableVectorView xdot) const { xdot = u; }
  const ContinuousState x_;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

/// Integrator7 with a witness that never crosses.
class Guarded7 final : public System {
 public:
  Guarded7()
      : x_(DeclareContinuousState("x", {kWidth}, 0.0)),
        in(DeclareInput<Vector>("in", {kWidth})),
        out(DeclareStateOutput("out", x_)) {
    DeclareDerivative<&Guarded7::Derivative>(x_, in);
    const Witness limit = DeclareWitness<&Guarded7::Limit>("limit", Direction::kBoth, x_);
    DeclareReset<&Guarded7::Stop>(When{limit}, Writes(x_));
  }

 private:
  void Derivative(VectorView u, MutableVectorView xdot) const { xdot = u; }
  double Limit(VectorView x) const { return 100.0 - x[0]; }
  void Stop(MutableVectorView x) const { x.setZero(); }
  const ContinuousState x_;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

/// x' = v, v turned round at 0 and 1: from x = 0.5, v = 100 a crossing every 10 ms.
class Shuttle final : public System {
 public:
  Shuttle()
      : x_(DeclareContinuousState("x", {1}, 0.5)),
        v_(DeclareDiscreteState("v", {1}, 100.0)),
        out(DeclareStateOutput("out", x_)) {
    DeclareDerivative<&Shuttle::Derivative>(x_, v_);
    const Witness low = DeclareWitness<&Shuttle::Low>("low", Direction::kFalling, x_);
    const Witness high = DeclareWitness<&Shuttle::High>("high", Direction::kRising, x_);
    DeclareReset<&Shuttle::Turn>(When{low}, Writes(v_), v_);
    DeclareReset<&Shuttle::Turn>(When{high}, Writes(v_), v_);
  }

 private:
  void Derivative(VectorView v, MutableVectorView xdot) const { xdot = v; }
  double Low(VectorView x) const { return x[0]; }
  double High(VectorView x) const { return x[0] - 1.0; }
  void Turn(VectorView v, MutableVectorView turned) const { turned = -v; }
  const ContinuousState x_;
  const DiscreteState<Vector> v_;

 public:
  const Output<Vector> out;
};

/// Seven servos of second order behind a held target: x'' = w^2 (u - x) - 2 z w x', w 20, z 1.
class Servo14 final : public System {
 public:
  Servo14()
      : q_(DeclareContinuousState("q", {kWidth}, 0.0)),
        v_(DeclareContinuousState("v", {kWidth}, 0.0)),
        in(DeclareInput<Vector>("in", {kWidth})),
        out(DeclareStateOutput("out", q_)) {
    DeclareDerivative<&Servo14::Velocity>(q_, v_);
    DeclareDerivative<&Servo14::Acceleration>(v_, in, q_, v_);
  }

 private:
  void Velocity(VectorView v, MutableVectorView qdot) const { qdot = v; }
  void Acceleration(VectorView u, VectorView q, VectorView v, MutableVectorView vdot) const {
    vdot = 400.0 * (u - q) - 40.0 * v;
  }
  const ContinuousState q_;
  const ContinuousState v_;

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

}  // namespace oca::bench
