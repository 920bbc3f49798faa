// SPDX-License-Identifier: BSD-3-Clause
// A block of one's own: parameters, a state, an update, ports.
#include <cstdio>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/simulation/simulator.h"
#include "oca/systems/basics/sine_source.h"

/// The largest magnitude so far, which is forgotten slowly: peak' = max(|in|, keep peak).
class Peak final : public oca::System {
 public:
  struct Params {
    double keep{0.99};
    oca::Period period{1, 100};
    static void Describe(oca::Fields<Params>& fields) {
      fields.Add("keep", &Params::keep, "", "share that is left after a period").AtMost(1.0);
      fields.Add("period", &Params::period, "s", "between two looks").Above(0.0);
    }
  };

  explicit Peak(const Params& params)
      : params_(oca::Validated(params)),
        size_(DeclareSize()),  // as long as what is connected
        unit_(DeclareUnit()),
        state_(DeclareDiscreteState("peak", {size_, unit_}, 0.0)),
        in(DeclareInput<oca::Vector>("in", {size_, unit_})),
        peak(DeclareStateOutput("peak", state_)) {
    DeclareUpdate<&Peak::Look>({params_.period}, oca::Writes(state_), in);
  }

 private:
  void Look(oca::VectorView now, oca::MutableVectorView next) const {
    next = now.cwiseAbs().cwiseMax(params_.keep * next);
  }

  const Params params_;
  const oca::Size size_;
  const oca::Unit unit_;
  const oca::DiscreteState<oca::Vector> state_;

 public:
  const oca::Input<oca::Vector> in;
  const oca::Output<oca::Vector> peak;
};

int main() {
  oca::DiagramBuilder builder;
  const auto& sine = builder.Add<oca::systems::SineSource>("sine", {.amplitude = 2.0});
  const auto& peak = builder.Add<Peak>("peak", {.keep = 0.999});
  builder.Connect(sine.value, peak.in);
  const auto diagram = builder.Build();
  oca::Simulator simulator(*diagram);
  simulator.AdvanceTo(1.25);
  std::printf("peak %.3f\n", peak.peak.Eval(simulator.context())[0]);
}
