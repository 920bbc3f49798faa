// SPDX-License-Identifier: BSD-3-Clause
// The whole program `simulator`, which knows a block of one's own besides:
//     09_own_catalogue run tools/examples/09_own_catalogue.yaml
//     09_own_catalogue describe DeadZone
#include "oca/framework/dataflow/function.h"
#include "oca/tools/simulator/simulator_main.h"

/// out = in beyond `width` on either side, moved to 0; 0 within.
class DeadZone final : public oca::System {
 public:
  static constexpr oca::SystemDoc kDoc{"takes small numbers for nothing",
                                       "out_i = in_i - clamp(in_i, -width, width)", ""};
  struct Params {
    double width{0.1};
    static void Describe(oca::Fields<Params>& fields) {
      fields.Add("width", &Params::width, "", "magnitude that still counts as nothing").AtLeast(0);
    }
  };
  static Params Example() { return {.width = 0.5}; }

  explicit DeadZone(const Params& params)
      : params_(oca::Validated(params)),
        size_(DeclareSize()),
        unit_(DeclareUnit()),
        in(DeclareInput<oca::Vector>("in", {size_, unit_})),
        out(DeclareOutput<oca::Vector, &DeadZone::CalcOut>("out", {size_, unit_}, in)) {}

 private:
  void CalcOut(oca::VectorView now, oca::MutableVectorView rest) const {
    rest = now - now.cwiseMax(-params_.width).cwiseMin(params_.width);
  }

  const Params params_;
  const oca::Size size_;
  const oca::Unit unit_;

 public:
  const oca::Input<oca::Vector> in;
  const oca::Output<oca::Vector> out;
};

int main(int argc, char** argv) {
  auto catalogue = oca::files::Catalogue::Standard();
  catalogue.Add<DeadZone>("DeadZone");

  // What needs no class: a lambda.
  catalogue.Add("Norm", {"length of a vector", "out = |in|", ""}, [] {
    return oca::MakeBlock({.inputs = {{"in"}}, .output = {"out", 1}},
                          [](oca::VectorView in) { return in.norm(); });
  });
  return oca::tools::SimulatorMain(argc, argv, catalogue);
}
