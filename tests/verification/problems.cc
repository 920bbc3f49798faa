// SPDX-License-Identifier: BSD-3-Clause
#include "tests/verification/problems.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"

namespace oca::verification {
namespace {

using std::numbers::pi;

const char* const kClosedForm = "closed form";
const char* const kDetest = "closed form; Hull et al. 1972, DETEST";

/// A problem as one system.
class Equation final : public System {
 public:
  explicit Equation(const Problem& problem)
      : problem_(problem),
        x_(DeclareContinuousState(
            "x", {static_cast<int>(problem.initial.size())},
            PerComponent(Eigen::Map<const Eigen::VectorXd>(
                problem.initial.data(), static_cast<Eigen::Index>(problem.initial.size()))))),
        out(DeclareStateOutput("out", x_)) {
    DeclareDerivative<&Equation::Derive>(x_, kTime, x_);
  }

 private:
  void Derive(double t, VectorView x, MutableVectorView derivative) const {
    problem_.derive(t, x.data(), 0.0, derivative.data());
  }
  const Problem& problem_;
  const ContinuousState x_;

 public:
  const Output<Vector> out;
};

std::vector<Problem> Motions() {
  return {
      {"sine",
       "x' = sin 3t, x(0) = 0",
       kClosedForm,
       {0.0},
       [](double t, const double*, double, double* d) { d[0] = std::sin(3.0 * t); },
       10.0,
       {0.2819161833708053}},
      {"pendulum",
       "theta'' = -sin theta, theta(0) = 2 rad at rest",
       "Jacobi's elliptic functions, modulus sin 1",
       {2.0, 0.0},
       [](double, const double* x, double, double* d) { d[0] = x[1], d[1] = -std::sin(x[0]); },
       10.0,
       {0.7131481806013794, -1.531308504135835}},
      {"pendulum_period",
       "the same, after its period of 8.349752926918495 s",
       "4 K(sin 1), complete elliptic integral",
       {2.0, 0.0},
       [](double, const double* x, double, double* d) { d[0] = x[1], d[1] = -std::sin(x[0]); },
       8.349752926918495,
       {2.0, 0.0}},
      {"oscillators",
       "two masses, modes of 2 and 3 rad/s, from (1, 0) at rest",
       kClosedForm,
       {1.0, 0.0, 0.0, 0.0},
       [](double, const double* x, double, double* d) {
         d[0] = x[2], d[1] = x[3];
         d[2] = -6.5 * x[0] + 2.5 * x[1], d[3] = 2.5 * x[0] - 6.5 * x[1];
       },
       10.0,
       // -sin 20 -+ 1.5 sin 30 are the velocities
       {0.2811667558504880, 0.1269153059629040, -std::sin(20.0) - 1.5 * std::sin(30.0),
        -std::sin(20.0) + 1.5 * std::sin(30.0)}},
      {"kepler",
       "r'' = -r / norm(r)^3, eccentricity 0.6, from the perihelion",
       "Kepler's equation",
       {0.4, 0.0, 0.0, 2.0},
       [](double, const double* x, double, double* d) {
         const double r3 = std::pow(x[0] * x[0] + x[1] * x[1], 1.5);
         d[0] = x[2], d[1] = x[3], d[2] = -x[0] / r3, d[3] = -x[1] / r3;
       },
       20.0,
       {-0.7700755784112404, 0.7883448169944244, -0.8941837319886915, -0.1234617641584410}},
  };
}

std::vector<Problem> Detest() {
  return {
      {"detest_a2",
       "x' = -x^3 / 2, x(0) = 1",
       kDetest,
       {1.0},
       [](double, const double* x, double, double* d) { d[0] = -0.5 * x[0] * x[0] * x[0]; },
       20.0,
       {0.2182178902359924}},
      {"detest_a3",
       "x' = x cos t, x(0) = 1",
       kDetest,
       {1.0},
       [](double t, const double* x, double, double* d) { d[0] = x[0] * std::cos(t); },
       20.0,
       {2.491650271850415}},
      {"detest_a4",
       "x' = x (1 - x / 20) / 4, x(0) = 1",
       kDetest,
       {1.0},
       [](double, const double* x, double, double* d) { d[0] = 0.25 * x[0] * (1 - x[0] / 20); },
       20.0,
       {17.73016648131484}},
  };
}

std::vector<Problem> StiffProblems() {
  return {
      {.name = "prothero_robinson",
       .equation = "x' = -1e6 (x - cos t) - sin t, x(0) = 1",
       .source = "closed form; Prothero and Robinson 1974",
       .initial = {1.0},
       .derive = [](double t, const double* x, double,
                    double* d) { d[0] = -1e6 * (x[0] - std::cos(t)) - std::sin(t); },
       .end = 10.0,
       .answer = {std::cos(10.0)},
       .stiff = true},
      {.name = "robertson",
       .equation = "Robertson's kinetics, from (1, 0, 0)",
       .source = "Hairer and Wanner 1996, section IV.10",
       .initial = {1.0, 0.0, 0.0},
       .derive =
           [](double, const double* x, double, double* d) {
             const double slow = 0.04 * x[0], fast = 1e4 * x[1] * x[2], pair = 3e7 * x[1] * x[1];
             d[0] = fast - slow, d[1] = slow - fast - pair, d[2] = pair;
           },
       .end = 40.0,
       .answer = {0.7158270687194051, 9.185534764557764e-6, 0.2841637457458304},
       .stiff = true,
       .relative = true,
       .absolute = 1e-8},
  };
}

std::vector<Problem> NamedProblems() {
  std::vector<Problem> all = Motions();
  for (const auto& more : {Detest(), StiffProblems()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

void Lag(double x, double u, double* derivative) { *derivative = (u - x) / 0.05; }
double Sine(double t, const double*) { return std::sin(2.0 * pi * t); }
template <int kDampingPercent>
void Servo(double, const double* x, double, double* d) {
  d[0] = x[1];
  d[1] = 400.0 * (1.0 - x[0]) - 0.4 * kDampingPercent * x[1];
}

std::vector<Problem> PlantProblems() {
  const auto problem = [](const char* name, const char* equation, std::vector<double> initial,
                          auto* derive) {
    const PlantCase& plant = PlantNamed(name);
    Problem made{name, equation, kClosedForm, std::move(initial), derive, 0.0, {}};
    made.plant = &plant;
    const Plant sample = plant.make();
    made.end = sample.end;
    for (const Plant::Answer& answer : sample.answers) made.answer.push_back(answer.value);
    return made;
  };
  using Derive = void(double, const double*, double, double*);
  std::vector<Problem> all{
      problem("held_sine_into_integrator", "x' = u, sin 2 pi t held for 1 ms", {0.0},
              static_cast<Derive*>([](double, const double*, double u, double* d) { d[0] = u; })),
      problem("lag_of_step", "0.05 x' = 1 - x", {0.0},
              static_cast<Derive*>(
                  [](double, const double* x, double, double* d) { Lag(x[0], 1.0, d); })),
      problem("lag_of_ramp", "0.05 x' = t - x", {0.0},
              static_cast<Derive*>(
                  [](double t, const double* x, double, double* d) { Lag(x[0], t, d); })),
      problem("lag_of_sine", "0.05 x' = sin 2 pi t - x", {0.0},
              static_cast<Derive*>(
                  [](double t, const double* x, double, double* d) { Lag(x[0], Sine(t, x), d); })),
      problem("lag_of_staircase", "0.05 x' = u - x, sin 2 pi t held for 10 ms", {0.0},
              static_cast<Derive*>(
                  [](double, const double* x, double u, double* d) { Lag(x[0], u, d); })),
      problem("servo_half_damped", "step of a servo, 20 rad/s, damping 0.5", {0.0, 0.0},
              &Servo<50>),
      problem("servo_critical", "step of a servo, 20 rad/s, damping 1", {0.0, 0.0}, &Servo<100>),
      problem("sampled_pd", "x'' = u, u = -25 x - 8 x' held for 10 ms", {1.0, 0.0},
              static_cast<Derive*>(
                  [](double, const double* x, double u, double* d) { d[0] = x[1], d[1] = u; })),
  };
  all[0].period = Period(1, 1000), all[0].sample = Sine;
  all[4].period = Period(1, 100), all[4].sample = Sine;
  all[7].period = Period(1, 100);
  all[7].sample = [](double, const double* x) { return -25.0 * x[0] - 8.0 * x[1]; };
  return all;
}

}  // namespace

double Problem::ErrorOf(const std::vector<double>& state) const {
  double error = 0.0;
  for (std::size_t i = 0; i < answer.size(); ++i) {
    const double scale = relative ? std::fabs(answer[i]) : 1.0;
    error = std::max(error, std::fabs(state[i] - answer[i]) / scale);
  }
  return error;
}

const std::vector<Problem>& Problems() {
  static const std::vector<Problem> all = [] {
    std::vector<Problem> problems = NamedProblems();
    for (Problem& plant : PlantProblems()) problems.push_back(std::move(plant));
    return problems;
  }();
  return all;
}

const Problem& ProblemNamed(const std::string& name) {
  for (const Problem& problem : Problems()) {
    if (problem.name == name) return problem;
  }
  throw std::out_of_range("no problem " + name);
}

Outcome Simulate(const Problem& problem, const IntegratorOptions& options) {
  Plant plant;
  if (problem.plant != nullptr) plant = problem.plant->make();
  if (problem.plant == nullptr) plant.diagram = MakeDiagramOf(std::make_unique<Equation>(problem));
  Simulator simulator(*plant.diagram, options);
  simulator.AdvanceTo(problem.end);
  std::vector<double> state;
  for (const Plant::Answer& answer : plant.answers) {
    state.push_back(answer.output.Eval(simulator.context())[0]);
  }
  const VectorView x = simulator.context().continuous_state();
  if (problem.plant == nullptr) state.assign(x.begin(), x.end());
  const IntegratorStatistics& cost = simulator.statistics().integrator;
  return {problem.ErrorOf(state), static_cast<long>(cost.steps),
          static_cast<long>(cost.derivative_calls)};
}

const std::vector<OrderCase>& OrderCases() {
  static const std::vector<OrderCase> cases{
      {"sine", 20}, {"pendulum", 40}, {"oscillators", 20}, {"kepler", 80}, {"detest_a3", 20}};
  return cases;
}

double ObservedOrder(const Problem& problem, IntegratorKind kind, int steps) {
  const auto error = [&](int a_second) {
    return Simulate(problem, {.integrator = kind, .fixed_step = 1.0 / a_second}).error;
  };
  return std::log2(error(steps) / error(2 * steps));
}

IntegratorOptions WithTolerance(const Problem& problem, IntegratorKind kind, double relative) {
  return {.integrator = kind,
          .relative_tolerance = relative,
          .absolute_tolerance = problem.absolute * relative};
}

}  // namespace oca::verification
