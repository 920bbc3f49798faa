// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/access.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "oca/framework/dataflow/error.h"

namespace oca::live {
namespace access_test {

using testing::HasSubstr;

constexpr int kPort = 8765;
const std::string kToken = "0123456789abcdef0123456789abcdef";

/// Status of the answer: 200, or why not.
int StatusOf(const Access& access, const Claims& claims) {
  const auto refusal = access.Judge(claims);
  return refusal ? refusal->status : 200;
}

/// A request to a server on the loopback, without Origin.
int ToHost(const std::string& host, const std::string& address = "127.0.0.1",
           const std::string& reached = "127.0.0.1") {
  return StatusOf(Access({.address = address, .port = kPort}),
                  {.hosts = {host}, .origins = {}, .reached = reached});
}

/// A request to localhost from a page of an origin.
int From(const std::string& origin, std::vector<std::string> allowed = {},
         const std::string& host = "localhost:8765") {
  return StatusOf(Access({.address = "127.0.0.1", .port = kPort, .origins = std::move(allowed)}),
                  {.hosts = {host}, .origins = {origin}});
}

TEST(AccessTest, AnswersToTheNamesOfTheLoopback) {
  for (const char* host :
       {"127.0.0.1:8765", "localhost:8765", "[::1]:8765", "LOCALHOST:8765", "LocalHost:8765",
        "localhost", "127.0.0.1", "[::1]", "127.8.9.10:8765", "[0:0:0:0:0:0:0:1]:8765",
        "[::ffff:127.0.0.1]:8765", "[::FFFF:7f00:1]:8765"}) {
    EXPECT_EQ(ToHost(host), 200) << host;
  }
}

TEST(AccessTest, RefusesEveryOtherName) {
  for (const char* host : {"evil.example",
                           "evil.example:8765",
                           "localhost.evil.example:8765",
                           "127.0.0.1.nip.io:8765",
                           "evil.localhost:8765",
                           "localhost.:8765",
                           "127.0.0.1.:8765",
                           "localhost:8766",
                           "localhost:80",
                           "localhost:",
                           "localhost:08765x",
                           "localhost:-8765",
                           "localhost:+8765",
                           "localhost:8765:8765",
                           "localhost:74301",
                           "user@localhost:8765",
                           "localhost:8765@evil.example",
                           "localhost:8765/",
                           "localhost :8765",
                           " localhost",
                           "",
                           ":8765",
                           "::1",
                           "::1:8765",
                           "[::1",
                           "::1]:8765",
                           "[::1]8765",
                           "[::1]:",
                           "[]",
                           "[::2]:8765",
                           "[::1%25lo]:8765",
                           "[127.0.0.1]:8765",
                           "0.0.0.0:8765",
                           "[::]:8765",
                           "127.1:8765",
                           "2130706433:8765",
                           "0x7f000001:8765",
                           "0177.0.0.1:8765",
                           "192.168.1.5:8765",
                           "localh\xc3\xb6st:8765",
                           "localhost,evil.example",
                           "http://localhost:8765"}) {
    EXPECT_EQ(ToHost(host), 403) << host;
  }
}

TEST(AccessTest, AnswersToTheAddressThatItListensOnAndTheOneThatWasReached) {
  EXPECT_EQ(ToHost("192.168.1.5:8765", "192.168.1.5", "192.168.1.5"), 200);
  EXPECT_EQ(ToHost("192.168.1.6:8765", "192.168.1.5", "192.168.1.5"), 403);
  EXPECT_EQ(ToHost("[fe80::1]:8765", "fe80::1%eth0", "fe80::1%2"), 200);
  EXPECT_EQ(ToHost("[2001:DB8:0::1]:8765", "2001:db8::1", "2001:db8::1"), 200);
  EXPECT_EQ(ToHost("0.0.0.0:8765", "0.0.0.0", "127.0.0.1"), 200);
  EXPECT_EQ(ToHost("10.0.0.7:8765", "0.0.0.0", "10.0.0.7"), 200);
  EXPECT_EQ(ToHost("10.0.0.7:8765", "::", "::ffff:10.0.0.7"), 200);
  EXPECT_EQ(ToHost("10.0.0.8:8765", "0.0.0.0", "10.0.0.7"), 403);
  EXPECT_EQ(ToHost("robot.example:8765", "0.0.0.0", "10.0.0.7"), 403);
}

TEST(AccessTest, WantsOneHostAndAPath) {
  const Access access({.address = "127.0.0.1", .port = kPort});
  EXPECT_EQ(StatusOf(access, {.hosts = {}, .origins = {}}), 400);
  EXPECT_EQ(StatusOf(access, {.hosts = {"localhost", "localhost"}, .origins = {}}), 400);
  EXPECT_EQ(StatusOf(access, {.hosts = {"localhost", "evil.example"}, .origins = {}}), 400);
  EXPECT_EQ(StatusOf(access, {{"localhost"}, {}, "http://evil.example/"}), 400);
  EXPECT_EQ(StatusOf(access, {{"localhost"}, {}, ""}), 400);
}

TEST(AccessTest, LetsInItsOwnPageAndWhatIsNoBrowser) {
  EXPECT_EQ(ToHost("localhost:8765"), 200);  // no Origin
  EXPECT_EQ(From("http://localhost:8765"), 200);
  EXPECT_EQ(From("HTTP://LOCALHOST:8765"), 200);
  EXPECT_EQ(From("http://127.0.0.1:8765", {}, "127.0.0.1:8765"), 200);
  EXPECT_EQ(From("http://[::1]:8765", {}, "[::1]:8765"), 200);
  const Access http({.address = "127.0.0.1", .port = 80});  // a browser leaves port 80 out
  EXPECT_EQ(StatusOf(http, {.hosts = {"localhost"}, .origins = {"http://localhost"}}), 200);
}

TEST(AccessTest, KeepsOutPagesOfOthers) {
  for (const char* origin : {"https://evil.example",
                             "http://evil.example:8765",
                             "null",
                             "",
                             "file://",
                             "http://localhost",
                             "http://localhost:3000",
                             "https://localhost:8765",
                             "http://127.0.0.1:8765",
                             "http://localhost:8765.evil.example",
                             "http://localhost:8765@evil.example",
                             "http://evil.example@localhost:8765",
                             "http://localhost.:8765",
                             "http://localhost:8765/",
                             "localhost:8765",
                             "//localhost:8765",
                             "http:localhost:8765",
                             "http://localhost:8765 http://evil.example",
                             "http://",
                             "https://app.foxglove.dev",
                             "chrome-extension://abcdef"}) {
    EXPECT_EQ(From(origin), 403) << origin;
  }
  const Access access({.address = "127.0.0.1", .port = kPort});
  EXPECT_EQ(StatusOf(access, {.hosts = {"localhost:8765"},
                              .origins = {"http://localhost:8765", "https://evil.example"}}),
            403);
  EXPECT_EQ(StatusOf(access, {.hosts = {"localhost:8765"},
                              .origins = {"http://localhost:8765", "http://localhost:8765"}}),
            403);
}

TEST(AccessTest, LetsInThePagesThatAreNamed) {
  EXPECT_EQ(From("https://app.foxglove.dev", {"foxglove"}), 200);
  EXPECT_EQ(From("https://studio.foxglove.dev", {"foxglove"}), 200);
  EXPECT_EQ(From("http://app.foxglove.dev", {"foxglove"}), 403);
  EXPECT_EQ(From("https://app.foxglove.dev.evil.example", {"foxglove"}), 403);
  EXPECT_EQ(From("https://app.foxglove.dev:8443", {"foxglove"}), 403);
  EXPECT_EQ(From("https://lichtblick-suite.github.io", {"foxglove", "lichtblick"}), 200);
  EXPECT_EQ(From("https://tools.example:8080", {"HTTPS://Tools.Example:8080"}), 200);
  EXPECT_EQ(From("https://tools.example", {"https://tools.example:443"}), 200);
  EXPECT_EQ(From("file://", {"file://"}), 200);
  EXPECT_EQ(From("null", {"file://"}), 403);
  EXPECT_EQ(From("http://localhost:8765", {"foxglove"}), 200);
}

TEST(AccessTest, RefusesAnOptionThatIsNoOrigin) {
  for (const char* origin : {"*", "https://*.foxglove.dev", "null", "", "foxglove.dev",
                             "https://a.example/path", "https://", "h ttp://a.example"}) {
    try {
      const Access access({.address = "127.0.0.1", .port = kPort, .origins = {origin}});
      FAIL() << origin;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("expected SCHEME://HOST[:PORT], foxglove or lichtblick"));
    }
  }
}

TEST(AccessTest, WantsTheTokenIfThereIsOne) {
  const Access access({.address = "192.168.1.5", .port = kPort, .token = kToken});
  const auto status = [&](const std::string& target, std::vector<std::string> origins = {}) {
    return StatusOf(access, {{"192.168.1.5:8765"}, std::move(origins), target, "192.168.1.5"});
  };
  EXPECT_EQ(status("/?token=" + kToken), 200);
  EXPECT_EQ(status("/?theme=dark&token=" + kToken), 200);
  EXPECT_EQ(status("/record.mcap?token=" + kToken + "&x=1"), 200);
  EXPECT_EQ(status("/?token=" + kToken, {"http://192.168.1.5:8765"}), 200);
  EXPECT_EQ(status("/?token=" + kToken, {"https://evil.example"}), 403);
  for (const std::string& target :
       {std::string("/"), std::string("/?token"), std::string("/?token="),
        "/?token=" + kToken.substr(1), "/?token=" + kToken + "0", "/?token=1" + kToken.substr(1),
        "/?Token=" + kToken, "/?xtoken=" + kToken, "/" + kToken, "/token=" + kToken,
        "/?token=" + kToken + "&token=" + kToken, "/?token=wrong&token=" + kToken}) {
    EXPECT_EQ(status(target), 403) << target;
  }
}

TEST(AccessTest, SaysWhyWithoutWhatIsSecretOrUnprintable) {
  const Access access({.address = "192.168.1.5", .port = kPort, .token = kToken});
  const auto bad_token = access.Judge({{"192.168.1.5"}, {}, "/?token=x", "192.168.1.5"});
  ASSERT_TRUE(bad_token);
  EXPECT_THAT(bad_token->why, testing::Not(HasSubstr(kToken)));
  const auto bad_host = access.Judge({{"a\x1b[2J" + std::string(5000, 'b')}, {}});
  ASSERT_TRUE(bad_host);
  EXPECT_THAT(bad_host->why, HasSubstr("a?[2Jbbb"));
  EXPECT_LT(bad_host->why.size(), 300u);
}

TEST(AccessTest, KnowsWhatOnlyThisMachineReaches) {
  for (const char* address : {"127.0.0.1", "127.0.0.2", "::1", "::ffff:127.0.0.1"}) {
    EXPECT_TRUE(IsLoopback(address)) << address;
  }
  for (const char* address : {"0.0.0.0", "::", "192.168.1.5", "::2", "localhost", "", "fe80::1%lo",
                              "128.0.0.1", "::ffff:10.0.0.1"}) {
    EXPECT_FALSE(IsLoopback(address)) << address;
  }
}

TEST(AccessTest, MakesATokenOf128BitsThatNobodyHadBefore) {
  std::set<std::string> tokens;
  for (int i = 0; i < 1000; ++i) tokens.insert(RandomToken());
  EXPECT_EQ(tokens.size(), 1000u);
  for (const std::string& token : tokens) {
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  }
}

}  // namespace access_test
}  // namespace oca::live
