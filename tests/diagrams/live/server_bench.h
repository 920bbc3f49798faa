// SPDX-License-Identifier: BSD-3-Clause
// What the tests of LiveServer share.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>
#include <vector>

#include "oca/diagrams/live/live_server.h"

namespace oca::live::server_bench {

inline const std::vector<record::RecordChannel> kChannels{
    {"/tf", "foxglove.FrameTransforms", "{}"},
    {"/scene/robots", "foxglove.SceneUpdate", "{}"},
    {"/plant/position", "oca.Joints", "{}"}};

inline LiveOptions AnyPort() {
  LiveOptions options;
  options.port = 0;
  options.page = "<html>the page</html>";
  return options;
}

inline testing::AssertionResult Eventually(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < end) {
    if (holds()) return testing::AssertionSuccess();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return testing::AssertionFailure() << "not within 20 s";
}

}  // namespace oca::live::server_bench
