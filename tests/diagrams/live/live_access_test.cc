// SPDX-License-Identifier: BSD-3-Clause
// What Access decides, on real connections: the page, the record and the WebSocket alike.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/read.hpp>
#include <boost/asio/read_until.hpp>
#include <chrono>
#include <thread>

#include "oca/diagrams/live/live_server.h"
#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/live/ws_client.h"

namespace oca::live {
namespace live_access_test {

using testing::HasSubstr;

LiveOptions AnyPort(const std::string& address = "127.0.0.1") {
  LiveOptions options;
  options.address = address;
  options.port = 0;
  options.page = "<html>the page</html>";
  options.record = "\x89MCAP";
  return options;
}

/// Sends lines as they are; the answer's head and body until the server hangs up or has greeted.
std::string Ask(int port, const std::string& lines) {
  asio::io_context io;
  tcp::socket socket = Connect(io, port);
  asio::write(socket, asio::buffer(lines + "\r\n"));
  std::string answer;
  beast::error_code error;
  const bool upgrade = lines.find("Upgrade: websocket") != std::string::npos;
  asio::read_until(socket, asio::dynamic_buffer(answer), "\r\n\r\n", error);
  if (!upgrade) asio::read(socket, asio::dynamic_buffer(answer), error);
  return answer;
}

const std::string kUpgrade =
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
    "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n";

int Status(const std::string& answer) {
  return answer.size() < 12 ? 0 : std::stoi(answer.substr(9, 3));
}

/// The statuses of the page, the record and the WebSocket for requests with some headers.
std::vector<int> Statuses(int port, const std::string& headers, const std::string& query = "") {
  std::vector<int> statuses;
  for (const char* path : {"/", "/record.mcap"}) {
    statuses.push_back(
        Status(Ask(port, "GET " + std::string(path) + query + " HTTP/1.1\r\n" + headers)));
  }
  statuses.push_back(Status(Ask(port, "GET /" + query + " HTTP/1.1\r\n" + headers + kUpgrade)));
  return statuses;
}

const std::vector<int> kAnswered{200, 200, 101}, kForbidden{403, 403, 403}, kBad{400, 400, 400};

TEST(LiveAccessTest, AnswersTheLoopbackByItsNames) {
  const LiveServer server(AnyPort());
  const std::string port = ":" + std::to_string(server.port());
  for (const std::string& host : {"127.0.0.1" + port, "localhost" + port, "[::1]" + port,
                                  "LocalHost" + port, std::string("localhost")}) {
    EXPECT_EQ(Statuses(server.port(), "Host: " + host + "\r\n"), kAnswered) << host;
  }
  EXPECT_EQ(server.statistics().forbidden, 0u);
}

TEST(LiveAccessTest, IsNotFoundByAnotherName) {
  const LiveServer server(AnyPort());
  const std::string port = ":" + std::to_string(server.port());
  for (const std::string& host :
       {std::string("evil.example"), "evil.example" + port, "localhost." + port,
        "user@localhost" + port, "192.168.1.5" + port, std::string("localhost:1")}) {
    EXPECT_EQ(Statuses(server.port(), "Host: " + host + "\r\n"), kForbidden) << host;
  }
  EXPECT_EQ(Statuses(server.port(), ""), kBad);
  EXPECT_EQ(Statuses(server.port(), "Host: localhost\r\nHost: localhost\r\n"), kBad);
  EXPECT_EQ(Statuses(server.port(), "Host: localhost\r\nHost: evil.example\r\n"), kBad);
  EXPECT_EQ(Status(Ask(server.port(), "GET / HTTP/1.0\r\n")), 400);
  EXPECT_EQ(Status(Ask(server.port(), "POST / HTTP/1.1\r\nHost: evil.example\r\n")), 403);
  EXPECT_EQ(Status(Ask(server.port(), "HEAD / HTTP/1.1\r\nHost: evil.example\r\n")), 403);
  EXPECT_EQ(server.statistics().forbidden, 30u);
  EXPECT_EQ(server.statistics().clients, 0);
}

TEST(LiveAccessTest, DoesNotTalkToPagesOfOthers) {
  LiveOptions options = AnyPort();
  options.origins = {"foxglove", "https://tools.example"};
  const LiveServer server(options);
  const std::string host = "127.0.0.1:" + std::to_string(server.port());
  const auto from = [&](const std::string& origins) {
    return Statuses(server.port(), "Host: " + host + "\r\n" + origins);
  };
  EXPECT_EQ(from("Origin: http://" + host + "\r\n"), kAnswered);
  EXPECT_EQ(from("Origin: https://app.foxglove.dev\r\n"), kAnswered);
  EXPECT_EQ(from("Origin: https://tools.example\r\n"), kAnswered);
  for (const std::string& origin :
       {std::string("https://evil.example"), std::string("null"), std::string("file://"),
        "https://" + host, std::string("http://127.0.0.1:1"),
        "http://localhost:" + std::to_string(server.port())}) {
    EXPECT_EQ(from("Origin: " + origin + "\r\n"), kForbidden) << origin;
  }
  EXPECT_EQ(from("Origin: http://" + host + "\r\nOrigin: https://evil.example\r\n"), kForbidden);
}

TEST(LiveAccessTest, SaysWhyItRefusesAndTellsThatOnce) {
  LiveOptions options = AnyPort();
  std::vector<std::string> told;
  options.forbidden = [&told](const std::string& why) { told.push_back(why); };
  {
    const LiveServer server(options);
    const std::string head = "GET / HTTP/1.1\r\nHost: localhost\r\nOrigin: ";
    for (int i = 0; i < 3; ++i) {
      EXPECT_THAT(Ask(server.port(), head + "https://evil.example\r\n"),
                  HasSubstr("Origin; got 'https://evil.example'; expected"));
    }
    for (int i = 0; i < 100; ++i) {
      Ask(server.port(), head + "https://evil" + std::to_string(i) + ".example\r\n");
    }
  }
  EXPECT_EQ(told.size(), 10u);  // a flood of names is no flood of lines
  EXPECT_THAT(told.front(), HasSubstr("--live-origin"));
}

TEST(LiveAccessTest, WantsTheTokenOfItsAddressWhereOthersReachIt) {
  const LiveServer server(AnyPort("0.0.0.0"));
  const std::string url = server.url(), host = "Host: " + url.substr(7, url.find('/', 7) - 7);
  const std::size_t at = url.find("?token=");
  ASSERT_NE(at, std::string::npos) << url;
  const std::string query = url.substr(at);
  EXPECT_EQ(query.size(), 7u + 32u);  // 128 bits
  EXPECT_EQ(Statuses(server.port(), host + "\r\n", query), kAnswered);
  EXPECT_EQ(Statuses(server.port(), host + "\r\n"), kForbidden);
  EXPECT_EQ(Statuses(server.port(), host + "\r\n", "?token=" + std::string(32, '0')), kForbidden);
  EXPECT_EQ(Statuses(server.port(), host + "\r\nOrigin: https://evil.example\r\n", query),
            kForbidden);
  EXPECT_EQ(Statuses(server.port(), "Host: evil.example\r\n", query), kForbidden);
  // By the address that it was reached by.
  const std::string reached = "Host: 127.0.0.1:" + std::to_string(server.port()) + "\r\n";
  EXPECT_EQ(Statuses(server.port(), reached, query), kAnswered);
  EXPECT_EQ(Statuses(server.port(), reached), kForbidden);

  const LiveServer other(AnyPort("0.0.0.0"));
  EXPECT_NE(other.url().substr(other.url().find('?')), query);
}

TEST(LiveAccessTest, NeedsNoTokenOnTheLoopback) {
  const LiveServer server(AnyPort());
  EXPECT_EQ(server.url(), "http://127.0.0.1:" + std::to_string(server.port()) + "/");
}

TEST(LiveAccessTest, IsNotShownWithinOtherPagesNorReadByThem) {
  const LiveServer server(AnyPort());
  const std::string answer = Ask(server.port(), "GET / HTTP/1.1\r\nHost: localhost\r\n");
  EXPECT_THAT(answer, HasSubstr("frame-ancestors 'none'"));
  EXPECT_THAT(answer, HasSubstr("Cross-Origin-Resource-Policy: same-origin"));
  EXPECT_THAT(answer, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(answer, testing::Not(HasSubstr("Access-Control-Allow-Origin")));
}

TEST(LiveAccessTest, RefusesAnOriginThatIsNone) {
  LiveOptions options = AnyPort();
  options.origins = {"*"};
  EXPECT_THROW(LiveServer{options}, ConfigError);
}

}  // namespace live_access_test
}  // namespace oca::live
