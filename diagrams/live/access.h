// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace oca::live {

struct AccessOptions {
  std::string address{};               ///< that the server listens on, a number
  int port;                            ///< of it
  std::vector<std::string> origins{};  ///< of other pages that may connect, see Access
  std::string token{};                 ///< that a request must bring; empty: none
};

/// What a request says of itself: the values of all headers of a name, in order.
struct Claims {
  std::vector<std::string> hosts{};
  std::vector<std::string> origins{};
  std::string target{"/"};
  std::string reached{};  ///< address of this machine that it came in by
};

struct Refusal {
  int status;         ///< of HTTP
  std::string why{};  ///< printable, without what is secret
};

/// Decides who may see and change a run: a browser lets any page that it shows send requests to
/// this machine, by name (DNS rebinding) and as WebSocket.
///
///     Host    one, naming this server: localhost, an address of the loopback, the address that it
///             listens on or that the request came in by; a port, if there is one, is the server's.
///             Letter case does not count; a trailing dot, a user and other names are refused.
///     Origin  none (no browser, or one that asks for the page), the server's own (http, host and
///             port as Host has them), or one that is allowed: `SCHEME://HOST[:PORT]`, `foxglove`
///             and `lichtblick` for their web applications. `null` is refused: any page can be it.
///     token   as `token=...` in the query, if there is one; compared in constant time.
///
/// source RFC 9112, 3.2; RFC 6454; WHATWG Fetch, "CORS check"
class Access {
 public:
  /// throws ConfigError if an origin is none.
  explicit Access(AccessOptions options);

  /// Empty if the request may be answered.
  std::optional<Refusal> Judge(const Claims& claims) const;

 private:
  struct Origin {
    std::string scheme, host;
    int port;
    bool operator==(const Origin&) const = default;
  };
  static std::optional<Origin> ParseOrigin(std::string_view text);
  bool IsThisServer(const std::string& host, const std::string& reached) const;
  bool HasToken(std::string_view target) const;

  AccessOptions options_;
  std::vector<Origin> origins_;
};

/// Whether only this machine reaches an address.
bool IsLoopback(const std::string& address);
/// 128 random bits of the operating system, in hexadecimal digits.
std::string RandomToken();

}  // namespace oca::live
