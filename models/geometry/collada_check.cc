// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/collada_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "oca/models/table_text.h"

namespace oca::geometry::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 200;
constexpr std::string_view kSpaces = " \t\r\n";

/// Goes over the tags of a text.
class ColladaScanner {
 public:
  ColladaScanner(const fs::path& file, std::string_view text) : file_(file), text_(text) {}

  void Check() {
    for (at_ = text_.find('<'); at_ < text_.size(); at_ = text_.find('<', at_)) Tag();
    for (const Accessor& accessor : accessors_) CheckAccessor(accessor);
  }

 private:
  struct Accessor {
    std::string_view source;
    std::uint64_t numbers;  // of the array, that it reaches to
  };

  [[noreturn]] void Refuse(std::string_view what, std::string_view got,
                           std::string_view expected) const {
    models::internal::RefuseText(file_, 0, what, got, expected);
  }

  void SkipPast(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    at_ = found == text_.npos ? text_.size() : found + end.size();
  }

  void Tag() {
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("<!--")) return SkipPast("-->");
    if (rest.starts_with("<![CDATA[")) return SkipPast("]]>");
    if (rest.starts_with("<?")) return SkipPast("?>");
    if (rest.starts_with("<!")) Refuse("Collada", "a document type declaration", "elements");
    const std::size_t end = EndOfTag();
    const std::string_view tag = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end;
    if (tag.starts_with('/')) {
      --depth_;
      return;
    }
    if (!tag.ends_with('/') && ++depth_ > kDeepest) {
      Refuse("Collada elements nested too deep", fmt::format("more than {}", kDeepest),
             "a file of a drawing program");
    }
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    if (name.ends_with("_array")) AddArray(tag);
    if (name == "accessor") AddAccessor(tag);
    if ((name == "p" || name == "vcount" || name == "v") && !tag.ends_with('/')) CheckIndices(name);
  }

  /// What stands in the element that has begun.
  void CheckIndices(std::string_view name) const {
    const std::size_t begin = std::min(at_ + 1, text_.size());
    const std::size_t end =
        std::min(text_.find_first_not_of("0123456789+- \t\r\n", begin), text_.size());
    if (text_.substr(end).starts_with("</")) return;
    Refuse(fmt::format("<{}>", name), models::internal::Shown(text_.substr(end, 20)),
           "whole numbers and its end");
  }

  /// Of the one that begins here: its '>', which values in quotes may hold too.
  std::size_t EndOfTag() const {
    char quote = 0;
    for (std::size_t i = at_; i < text_.size(); ++i) {
      const char c = text_[i];
      if (quote != 0) {
        if (c == quote) quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '>') {
        return i;
      }
    }
    return text_.size();
  }

  /// The value of the first attribute of a name; nothing if there is none.
  static std::string_view Attribute(std::string_view tag, std::string_view name) {
    std::size_t at = std::min(tag.find_first_of(kSpaces), tag.size());
    while (at < tag.size()) {
      const std::size_t equals = tag.find('=', at);
      const std::size_t open = std::min(tag.find_first_of("\"'", at), tag.size());
      if (equals >= open || open == tag.size()) return {};
      const std::size_t close = std::min(tag.find(tag[open], open + 1), tag.size());
      std::string_view key = tag.substr(at, equals - at);
      key.remove_prefix(std::min(key.find_first_not_of(kSpaces), key.size()));
      key = key.substr(0, key.find_first_of(kSpaces));
      if (key == name) return tag.substr(open + 1, close - open - 1);
      at = close + 1;
    }
    return {};
  }

  /// A whole number, `usual` without it.
  std::uint64_t Number(std::string_view tag, std::string_view name, std::uint64_t usual) const {
    const std::string_view text = models::internal::Trimmed(Attribute(tag, name));
    if (text.empty()) return usual;
    const auto number = models::internal::ToCount(text, std::numeric_limits<std::uint32_t>::max());
    if (!number) Refuse(name, models::internal::Shown(text), "a whole number");
    return *number;
  }

  /// Of two with one id the shorter counts.
  void AddArray(std::string_view tag) {
    const std::uint64_t count = Number(tag, "count", 0);
    const auto [place, fresh] = arrays_.emplace(Attribute(tag, "id"), count);
    if (!fresh) place->second = std::min(place->second, count);
  }

  void AddAccessor(std::string_view tag) {
    std::string_view source = Attribute(tag, "source");
    if (source.starts_with('#')) source.remove_prefix(1);
    // 32 bits each: no sum passes 64.
    accessors_.push_back(
        {source, Number(tag, "offset", 0) + Number(tag, "count", 0) * Number(tag, "stride", 1)});
  }

  void CheckAccessor(const Accessor& accessor) const {
    const auto array = arrays_.find(accessor.source);
    const std::uint64_t there = array == arrays_.end() ? 0 : array->second;
    if (accessor.numbers <= there) return;
    Refuse(fmt::format("accessor of '{}'", models::internal::Shown(accessor.source)),
           fmt::format("an array of {} numbers", there), fmt::format("{}", accessor.numbers));
  }

  const fs::path& file_;
  const std::string_view text_;
  std::size_t at_{0};
  int depth_{0};
  std::map<std::string_view, std::uint64_t> arrays_;  // how many numbers, by id
  std::vector<Accessor> accessors_;
};

}  // namespace

void CheckCollada(const fs::path& file, std::string_view text) {
  ColladaScanner(file, text).Check();
}

}  // namespace oca::geometry::internal
