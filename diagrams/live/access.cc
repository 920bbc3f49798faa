// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/access.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "oca/framework/dataflow/error.h"

namespace oca::live {
namespace {

constexpr int kBadRequest = 400;
constexpr int kForbidden = 403;

struct Authority {
  std::string host;  ///< as Canonical has it
  std::optional<int> port;
};

std::string Lower(std::string_view text) {
  std::string lower(text);
  for (char& letter : lower) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return lower;
}

/// An address of which there is one spelling only; empty if it is none. An IPv4 address within
/// IPv6 is the former; what stands behind a `%` says by which interface, and not where to.
std::string Canonical(const std::string& address) {
  in6_addr six{};
  in_addr four{};
  const std::string number = address.substr(0, address.find('%'));
  if (inet_pton(AF_INET6, number.c_str(), &six) == 1) {
    if (!IN6_IS_ADDR_V4MAPPED(&six)) {
      std::array<char, INET6_ADDRSTRLEN> text{};
      return inet_ntop(AF_INET6, &six, text.data(), text.size());
    }
    std::memcpy(&four, &six.s6_addr[12], sizeof four);
  } else if (inet_pton(AF_INET, number.c_str(), &four) != 1) {
    return "";
  }
  std::array<char, INET_ADDRSTRLEN> text{};
  return inet_ntop(AF_INET, &four, text.data(), text.size());
}

std::optional<int> ParsePort(std::string_view digits) {
  int port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  const bool plain = !digits.empty() && digits.front() >= '0' && digits.front() <= '9';
  if (!plain || error != std::errc() || end != digits.data() + digits.size() || port > 65535) {
    return std::nullopt;
  }
  return port;
}

/// `HOST[:PORT]` and nothing else: no user, no path, no trailing dot.
std::optional<Authority> ParseAuthority(std::string_view text) {
  Authority authority;
  std::string_view rest;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string address(text.substr(1, end - 1));
    if (address.find(':') == std::string::npos) return std::nullopt;
    if (address.find('%') != std::string::npos) return std::nullopt;
    authority.host = Canonical(address);
    rest = text.substr(end + 1);
  } else {
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::string name = Lower(text.substr(0, colon));
    const bool plain = std::all_of(name.begin(), name.end(), [](char letter) {
      return (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') ||
             letter == '-' || letter == '.' || letter == '_';
    });
    if (!plain || name.ends_with('.')) return std::nullopt;
    const std::string address = Canonical(name);
    authority.host = address.empty() ? name : address;
    rest = text.substr(colon);
  }
  if (authority.host.empty()) return std::nullopt;
  if (rest.empty()) return authority;
  if (rest.front() != ':') return std::nullopt;
  authority.port = ParsePort(rest.substr(1));
  return authority.port ? std::optional(authority) : std::nullopt;
}

/// What a stranger sent, as it may be printed.
std::string Printable(std::string_view text) {
  constexpr std::size_t kLongest = 100;
  std::string shown(text.substr(0, kLongest));
  for (char& letter : shown) {
    if (letter < ' ' || letter > '~' || letter == '\'') letter = '?';
  }
  return shown + (text.size() > kLongest ? "..." : "");
}

/// Takes as long whatever the texts are, if they are of one length.
bool SameInConstantTime(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  volatile unsigned char difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = static_cast<unsigned char>(
        difference | (static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i])));
  }
  return difference == 0;
}

std::vector<std::string> OriginsOf(const std::string& name) {
  if (name == "foxglove") return {"https://app.foxglove.dev", "https://studio.foxglove.dev"};
  if (name == "lichtblick") return {"https://lichtblick-suite.github.io"};
  return {name};
}

}  // namespace

bool IsLoopback(const std::string& address) {
  const std::string number = Canonical(address);
  return number == "::1" || number.starts_with("127.");
}

std::string RandomToken() {
  std::array<unsigned char, 16> bytes{};
  for (std::size_t filled = 0; filled < bytes.size();) {
    const auto count = getrandom(bytes.data() + filled, bytes.size() - filled, 0);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw ConfigError("live: token; got no random bits of the operating system");
    filled += static_cast<std::size_t>(count);
  }
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

std::optional<Access::Origin> Access::ParseOrigin(std::string_view text) {
  constexpr std::string_view kAuthority = "://";
  const std::size_t end = text.find(kAuthority);
  if (end == std::string_view::npos || end == 0) return std::nullopt;
  Origin origin{Lower(text.substr(0, end)), "", 0};
  const bool plain = std::all_of(origin.scheme.begin(), origin.scheme.end(), [](char letter) {
    return (letter >= 'a' && letter <= 'z') || letter == '-' || letter == '+';
  });
  if (!plain) return std::nullopt;
  const std::string_view rest = text.substr(end + kAuthority.size());
  if (origin.scheme == "file" && rest.empty()) return origin;
  const auto authority = ParseAuthority(rest);
  if (!authority) return std::nullopt;
  origin.host = authority->host;
  origin.port = authority->port.value_or(origin.scheme == "https" ? 443 : 80);
  return origin;
}

Access::Access(AccessOptions options) : options_(std::move(options)) {
  for (const std::string& name : options_.origins) {
    for (const std::string& text : OriginsOf(name)) {
      const auto origin = ParseOrigin(text);
      if (!origin) {
        throw ConfigError(
            fmt::format("live: origin; got '{}'; expected SCHEME://HOST[:PORT], "
                        "foxglove or lichtblick",
                        Printable(name)));
      }
      origins_.push_back(*origin);
    }
  }
}

bool Access::IsThisServer(const std::string& host, const std::string& reached) const {
  return host == "localhost" || IsLoopback(host) || host == Canonical(options_.address) ||
         host == Canonical(reached);
}

/// Exactly one `token` in the query.
bool Access::HasToken(std::string_view target) const {
  constexpr std::string_view kName = "token=";
  std::string_view given;
  int count = 0;
  std::size_t at = target.find('?');
  while (at != std::string_view::npos) {
    const std::string_view item = target.substr(at + 1, target.find('&', at + 1) - at - 1);
    if (item.starts_with(kName)) {
      given = item.substr(kName.size());
      ++count;
    }
    at = target.find('&', at + 1);
  }
  return count == 1 && SameInConstantTime(given, options_.token);
}

std::optional<Refusal> Access::Judge(const Claims& claims) const {
  if (claims.hosts.size() != 1) {
    return Refusal{kBadRequest, fmt::format("Host; got {}; expected one", claims.hosts.size())};
  }
  if (!claims.target.starts_with('/')) {
    return Refusal{kBadRequest, "target; got no path; expected one, as in GET /"};
  }
  const auto host = ParseAuthority(claims.hosts.front());
  if (!host || !IsThisServer(host->host, claims.reached) ||
      host->port.value_or(options_.port) != options_.port) {
    return Refusal{kForbidden, fmt::format("Host; got '{}'; expected localhost:{} or the address "
                                           "that the simulator printed",
                                           Printable(claims.hosts.front()), options_.port)};
  }
  if (!claims.origins.empty()) {
    const auto origin = ParseOrigin(claims.origins.front());
    const bool own = origin == Origin{"http", host->host, options_.port};
    const bool allowed =
        origin && (own || std::find(origins_.begin(), origins_.end(), *origin) != origins_.end());
    if (claims.origins.size() != 1 || !allowed) {
      return Refusal{kForbidden,
                     fmt::format("Origin; got '{}'; expected this page's own or one that "
                                 "--live-origin allows",
                                 Printable(claims.origins.front()))};
    }
  }
  if (!options_.token.empty() && !HasToken(claims.target)) {
    return Refusal{kForbidden,
                   "token; got none or another; expected the one in the address that "
                   "the simulator printed"};
  }
  return std::nullopt;
}

}  // namespace oca::live
