// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/sample_queue.h"

#include <gtest/gtest.h>

#include <thread>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/systems/basics/gain.h"

namespace oca::record {
namespace sample_queue_test {

/// A gain of 1: its output is what it is told.
class SampleQueueTest : public testing::Test {
 protected:
  static std::unique_ptr<Diagram> MakeGain() {
    auto params = systems::Gain::Example();
    params.gain = {1.0};
    return MakeDiagramOf(std::make_unique<systems::Gain>(params), {{"in", 1}});
  }
  void SetTime(double time) {
    context_.SetTime(time);
    diagram_->GetInput<Vector>("in").Fix(context_, Eigen::VectorXd::Constant(1, time));
  }
  std::unique_ptr<Diagram> diagram_{MakeGain()};
  Context context_{diagram_->MakeContext()};
  OutputHandle value_{diagram_->FindOutput("out")};

  static double First(const SampleQueue::Sample& sample) {
    return *static_cast<const double*>(sample.values[0]);
  }
};

TEST_F(SampleQueueTest, GivesSamplesAndTextsInTheOrderTheyCameIn) {
  SampleQueue queue({{{value_}, 4}, {{value_}, 4}}, *diagram_, context_);
  SetTime(1.0);
  EXPECT_TRUE(queue.Store(1, context_));
  EXPECT_TRUE(queue.StoreText(2, 1.5, "hello"));
  SetTime(2.0);
  EXPECT_TRUE(queue.Store(0, context_));
  std::string order;
  const auto note = [&](const SampleQueue::Sample& sample) {
    order += sample.group < 0 ? std::string(sample.text) : std::to_string(sample.group);
    if (sample.group >= 0) {
      EXPECT_EQ(First(sample), sample.time);
    }
  };
  while (queue.Take(note)) continue;
  EXPECT_EQ(order, "1hello0");
}

TEST_F(SampleQueueTest, CountsWhatFindsNoRoom) {
  SetTime(0.0);
  SampleQueue queue({{{value_}, 2}}, *diagram_, context_);
  EXPECT_TRUE(queue.Store(0, context_));
  EXPECT_TRUE(queue.HasRoom(0));
  EXPECT_TRUE(queue.Store(0, context_));
  EXPECT_FALSE(queue.HasRoom(0));
  EXPECT_FALSE(queue.Store(0, context_));
  EXPECT_EQ(queue.dropped(), 1);
  EXPECT_TRUE(queue.Take([](const auto&) {}));
  EXPECT_TRUE(queue.Store(0, context_));
  EXPECT_EQ(queue.dropped(), 1);
}

TEST_F(SampleQueueTest, CutsATextThatIsTooLong) {
  SampleQueue queue({}, *diagram_, context_);
  queue.StoreText(1, 0.0, std::string(SampleQueue::kTextSize + 1, 'x'));
  std::size_t size = 0;
  queue.Take([&](const auto& sample) { size = sample.text.size(); });
  EXPECT_EQ(size, SampleQueue::kTextSize);
}

TEST_F(SampleQueueTest, LosesNothingBetweenTwoThreads) {
  constexpr int kSamples = 20000;
  SampleQueue queue({{{value_}, 16}}, *diagram_, context_);
  int taken = 0;
  bool ordered = true;
  std::thread taker([&] {
    while (taken < kSamples) {
      queue.Take([&](const SampleQueue::Sample& sample) {
        ordered = ordered && First(sample) == static_cast<double>(taken);
        ++taken;
      });
    }
  });
  for (int i = 0; i < kSamples; ++i) {
    SetTime(i);
    while (!queue.HasRoom(0)) std::this_thread::yield();
    queue.Store(0, context_);
  }
  taker.join();
  EXPECT_TRUE(ordered);
  EXPECT_EQ(queue.dropped(), 0);
}

}  // namespace sample_queue_test
}  // namespace oca::record
