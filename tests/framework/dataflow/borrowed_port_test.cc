// SPDX-License-Identifier: BSD-3-Clause
// Systems that use ports and states that are not theirs, or not there yet.
#include <gmock/gmock.h>

#include <string>

#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace borrowed_port_test {

using testing::HasSubstr;

/// A system that uses ports and states of `Of`, its own or those of another one, in one place.
class Borrower final : public System {
 public:
  enum class Use {
    kInput,
    kOutput,
    kState,
    kDerivative,
    kDriven,
    kWitness,
    kEvent,
    kWritten,
    kShown
  };
  explicit Borrower(Use use, const Borrower* of = nullptr) {
    if (of == nullptr) of = this;
    x_ = DeclareContinuousState("x", {1}, 0.0);
    s_ = DeclareDiscreteState("s", {1}, 0.0);
    u_ = DeclareInput<Vector>("u", {1});
    y_ = DeclareOutput<Vector, &Borrower::Copy>("y", {1}, u_);
    switch (use) {
      case Use::kInput:
        DeclareOutput<Vector, &Borrower::Copy>("z", {1}, of->u_);
        break;
      case Use::kOutput:
        DeclareOutput<Vector, &Borrower::Copy>("z", {1}, of->y_);
        break;
      case Use::kState:
        DeclareOutput<Vector, &Borrower::Copy>("z", {1}, of->s_);
        break;
      case Use::kDerivative:
        DeclareDerivative<&Borrower::Copy>(x_, of->x_);
        break;
      case Use::kDriven:
        DeclareDerivative<&Borrower::Copy>(of->x_, x_);
        break;
      case Use::kWitness:
        DeclareWitness<&Borrower::First>("w", Direction::kBoth, of->u_);
        break;
      case Use::kEvent:
        DeclareUpdate<&Borrower::Copy>(kEvery, Writes(s_), of->u_);
        break;
      case Use::kWritten:
        DeclareUpdate<&Borrower::Copy>(kEvery, Writes(of->s_), u_);
        break;
      case Use::kShown:
        DeclareStateOutput("z", of->s_);
        break;
    }
  }

 private:
  const Every kEvery{Period(1, 10)};
  void Copy(VectorView from, MutableVectorView to) const { to = from; }
  double First(VectorView from) const { return from[0]; }
  ContinuousState x_;
  DiscreteState<Vector> s_;
  Input<Vector> u_;
  Output<Vector> y_;
};

std::string RefusalOfBorrowing(Borrower::Use use) {
  EXPECT_NO_THROW(Borrower alone(use)) << static_cast<int>(use);
  const Borrower lender(use);
  try {
    const Borrower borrower(use, &lender);
  } catch (const WiringError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BorrowedPortTest, ACalculationThatReadsPortsOrStatesOfAnotherSystemIsRefused) {
  using Use = Borrower::Use;
  const std::string expected = " of another system in place 0; expected one declared before it";
  EXPECT_EQ(RefusalOfBorrowing(Use::kInput), "output 'z': reads; got an input" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kOutput), "output 'z': reads; got an output" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kState), "output 'z': reads; got a state" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kDerivative),
            "derivative of 'x': reads; got a state" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kWitness), "witness 'w': reads; got an input" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kEvent), "update: reads; got an input" + expected);
}

TEST(BorrowedPortTest, AStateOfAnotherSystemIsNeitherDrivenNorWrittenNorShown) {
  for (const auto use : {Borrower::Use::kDriven, Borrower::Use::kWritten, Borrower::Use::kShown}) {
    EXPECT_THAT(RefusalOfBorrowing(use), HasSubstr("got one of another system"));
  }
}

TEST(BorrowedPortTest, APortReadBeforeItIsDeclaredIsRefused) {
  struct Hasty : System {
    Hasty() { DeclareOutput<Vector, &Hasty::Calc>("out", {1}, in); }
    void Calc(VectorView from, MutableVectorView to) const { to = from; }
    Input<Vector> in;
  };
  EXPECT_THROW(Hasty(), WiringError);
}

}  // namespace borrowed_port_test
}  // namespace oca
