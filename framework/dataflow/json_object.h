// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace oca {

/// Writes a JSON object member by member, as a Signal<T>::WriteJson has to, without a JSON library
/// in the header that says it. Numbers are the shortest texts that read back the same.
class JsonObject {
 public:
  /// Appends to `out`, where the object ends as this is destroyed.
  explicit JsonObject(std::string& out) : out_(out) { out_ += '{'; }
  JsonObject(const JsonObject&) = delete;
  JsonObject& operator=(const JsonObject&) = delete;
  ~JsonObject() { out_ += '}'; }

  JsonObject& Number(std::string_view key, double number);
  JsonObject& Numbers(std::string_view key, std::span<const double> numbers);
  JsonObject& Flag(std::string_view key, bool flag);
  JsonObject& Text(std::string_view key, std::string_view text);

 private:
  void Key(std::string_view key);

  std::string& out_;
  bool first_{true};
};

/// Reads such an object, as a Signal<T>::ReadJson has to. All members throw ConfigError
/// `KEY: got X; expected Y`, which says what was found and what can be.
class JsonMembers {
 public:
  /// Refuses anything but an object that has all these keys and no others.
  JsonMembers(std::string_view text, std::initializer_list<const char*> keys);
  JsonMembers(const JsonMembers&) = delete;
  JsonMembers& operator=(const JsonMembers&) = delete;
  ~JsonMembers();

  double Number(const char* key) const;
  std::vector<double> Numbers(const char* key) const;
  bool Flag(const char* key) const;
  std::string Text(const char* key) const;

 private:
  struct Tree;
  const std::unique_ptr<const Tree> tree_;
};

}  // namespace oca
