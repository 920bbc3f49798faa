// SPDX-License-Identifier: BSD-3-Clause
#include "oca/version.h"

#include <gtest/gtest.h>

#include <string>

namespace oca {

TEST(VersionTest, LibraryAndHeadersSayTheSame) {
  const std::string numbers = std::to_string(OCA_VERSION_MAJOR) + "." +
                              std::to_string(OCA_VERSION_MINOR) + "." +
                              std::to_string(OCA_VERSION_PATCH);
  EXPECT_EQ(Version(), numbers);
  EXPECT_EQ(OCA_VERSION, numbers);
}

}  // namespace oca
