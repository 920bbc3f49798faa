// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "oca/framework/dataflow/error.h"
#include "tests/temporary_folder.h"

namespace oca::record {
namespace page_test {

using testing::HasSubstr;

constexpr char kPage[] = "<head><!--oca:source--></head>";
constexpr char kOpen[] = "<script id=\"oca-record\" type=\"application/octet-stream;base64\">";

std::string Embedded(std::string_view bytes) {
  const std::string page = PageWithRecord(kPage, bytes);
  const std::size_t start = page.find(kOpen) + sizeof kOpen - 1;
  return page.substr(start, page.find("</script>") - start);
}

// Values from RFC 4648, section 10.
TEST(PageTest, HoldsARecordAsBase64) {
  EXPECT_EQ(Embedded(""), "");
  EXPECT_EQ(Embedded("f"), "Zg==");
  EXPECT_EQ(Embedded("fo"), "Zm8=");
  EXPECT_EQ(Embedded("foo"), "Zm9v");
  EXPECT_EQ(Embedded("foob"), "Zm9vYg==");
  EXPECT_EQ(Embedded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Embedded(std::string_view("\xff\xfe\x00", 3)), "//4A");
}

TEST(PageTest, NamesTheSourceThatItsServerHas) {
  EXPECT_EQ(PageWithSource(kPage, "live"),
            "<head><meta name=\"oca-source\" content=\"live\"></head>");
}

TEST(PageTest, RefusesAPageWithoutAPlaceForTheSource) {
  EXPECT_THROW(PageWithSource("<html>", "live"), ConfigError);
  EXPECT_THROW(PageWithRecord("<html>", "x"), ConfigError);
}

TEST(PageTest, LoadsTheFileThatTheEnvironmentNames) {
  const oca::test::TemporaryFolder folder;
  const auto path = folder.path() / "page.html";
  std::ofstream(path) << kPage;
  ASSERT_EQ(setenv("OCA_VIEWER", path.c_str(), 1), 0);
  EXPECT_EQ(LoadPage(), kPage);
  unsetenv("OCA_VIEWER");
}

TEST(PageTest, SaysHowToBuildThePageIfThereIsNone) {
  unsetenv("OCA_VIEWER");
  try {
    LoadPage();
    FAIL() << "a page beside the test program?";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("npm ci"));
    EXPECT_THAT(error.what(), HasSubstr("viewer/viewer.html"));
  }
}

}  // namespace page_test
}  // namespace oca::record
