// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/collada_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "oca/models/table_text.h"

namespace oca::geometry::internal {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 200;
constexpr std::size_t kMostTreeElements = 1'000'000;
constexpr std::size_t kLongestAttributes = 4096;
constexpr std::uint64_t kMostTreeSteps = 20'000'000;

/// Goes over the tags of a text.
class ColladaScanner {
 public:
  ColladaScanner(const fs::path& file, std::string_view text) : file_(file), text_(text) {}

  std::vector<ColladaElement> Scan() {
    while (GoTo(text_.find('<', at_)), at_ < text_.size()) Tag();
    if (open_ >= 0) {
      Refuse(fmt::format("ends within <{}>", Name(open_)), "the end of the text",
             fmt::format("</{}>", Name(open_)));
    }
    return std::move(elements_);
  }

 private:
  [[noreturn]] void Refuse(std::string_view what, std::string_view got,
                           std::string_view expected) const {
    models::internal::RefuseText(file_, line_, what, got, expected);
  }

  std::string Name(int element) const { return models::internal::Shown(elements_[element].name); }

  void GoTo(std::size_t place) {
    place = std::min(place, text_.size());
    line_ += static_cast<int>(std::count(text_.begin() + at_, text_.begin() + place, '\n'));
    at_ = place;
  }

  void SkipPast(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == text_.npos) Refuse("Collada", "the end of the text", end);
    GoTo(found + end.size());
  }

  void Tag() {
    const std::string_view rest = text_.substr(at_);
    if (rest.starts_with("<!--")) return SkipPast("-->");
    if (rest.starts_with("<![CDATA[")) return SkipPast("]]>");
    if (rest.starts_with("<?")) return SkipPast("?>");
    if (rest.starts_with("<!")) Refuse("Collada", "a document type declaration", "elements");
    const std::size_t end = EndOfTag();
    if (end == text_.size()) Refuse("Collada", "the end of the text in a tag", ">");
    const int line = line_;
    std::string_view tag = text_.substr(at_ + 1, end - at_ - 1);
    GoTo(end + 1);
    if (tag.starts_with('/')) return Close(tag.substr(1));
    const bool empty = tag.ends_with('/');
    if (empty) tag.remove_suffix(1);
    Open(tag, line);
    if (empty) Close(elements_.back().name);
  }

  void Open(std::string_view tag, int line) {
    if (elements_.size() == kMostTreeElements) {
      Refuse("Collada", "more elements", fmt::format("at most {}", kMostTreeElements));
    }
    if (open_ < 0 && !elements_.empty()) Refuse("Collada", "a second root element", "one");
    if (++depth_ > kDeepest) {
      Refuse("Collada elements nested too deep", fmt::format("more than {}", kDeepest),
             "a file of a drawing program");
    }
    const std::size_t end = std::min(tag.find_first_of(kXmlSpaces), tag.size());
    if (end == 0) Refuse("Collada", "a tag without a name", "a name");
    if (tag.size() > kLongestAttributes) {
      Refuse("tag", fmt::format("{} characters", tag.size()),
             fmt::format("at most {}", kLongestAttributes));
    }
    const std::size_t next = std::min(text_.find('<', at_), text_.size());
    elements_.push_back({tag.substr(0, end), tag.substr(end), text_.substr(at_, next - at_), line,
                         line_, open_, 0, text_.substr(next).starts_with("</")});
    open_ = static_cast<int>(elements_.size()) - 1;
  }

  void Close(std::string_view name) {
    name = name.substr(0, name.find_first_of(kXmlSpaces));
    if (open_ < 0 || elements_[open_].name != name) {
      Refuse("Collada", fmt::format("</{}>", models::internal::Shown(name)),
             open_ < 0 ? "an opening tag first" : fmt::format("</{}>", Name(open_)));
    }
    elements_[open_].end = static_cast<int>(elements_.size());
    open_ = elements_[open_].parent;
    --depth_;
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

  const fs::path& file_;
  const std::string_view text_;
  std::size_t at_{0};
  int line_{1};
  int depth_{0};
  int open_{-1};
  std::vector<ColladaElement> elements_;
};

}  // namespace

ColladaTree::ColladaTree(const fs::path& file, std::string_view text)
    : file_(file), elements_(ColladaScanner(file, text).Scan()) {
  if (elements_.empty()) {
    models::internal::RefuseText(file, 0, "is no Collada", "no element", "<COLLADA>");
  }
  if (elements_[0].name == "COLLADA") return;
  Refuse(0, "is no Collada", fmt::format("<{}>", models::internal::Shown(elements_[0].name)),
         "<COLLADA>");
}

std::vector<int> ColladaTree::Children(int element, std::string_view name) const {
  std::vector<int> children;
  for (int i = element + 1; i < elements_[element].end; i = elements_[i].end) {
    CountStep(element);
    if (name.empty() || elements_[i].name == name) children.push_back(i);
  }
  return children;
}

int ColladaTree::Child(int element, std::string_view name) const {
  for (int i = element + 1; i < elements_[element].end; i = elements_[i].end) {
    CountStep(element);
    if (elements_[i].name == name) return i;
  }
  return -1;
}

void ColladaTree::CountStep(int element) const {
  if (++steps_ <= kMostTreeSteps) return;
  Refuse(element, "elements and what refers to them", "more",
         fmt::format("at most {}", kMostTreeSteps));
}

std::string_view ColladaTree::Attribute(int element, std::string_view name) const {
  const std::string_view text = elements_[element].attributes;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t equals = text.find('=', at);
    const std::size_t open = std::min(text.find_first_of("\"'", at), text.size());
    if (equals >= open || open == text.size()) return {};
    const std::size_t close = std::min(text.find(text[open], open + 1), text.size());
    std::string_view key = text.substr(at, equals - at);
    key.remove_prefix(std::min(key.find_first_not_of(kXmlSpaces), key.size()));
    if (key.substr(0, key.find_first_of(kXmlSpaces)) == name) {
      return text.substr(open + 1, close - open - 1);
    }
    at = close + 1;
  }
  return {};
}

std::uint64_t ColladaTree::Number(int element, std::string_view name, std::uint64_t usual) const {
  const std::string_view text = models::internal::Trimmed(Attribute(element, name));
  if (text.empty()) return usual;
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  const auto number = models::internal::ToCount(text, kMost);
  if (!number) {
    Refuse(element, name, models::internal::Shown(text),
           fmt::format("a whole number of at most {}", kMost));
  }
  return *number;
}

void ColladaTree::Refuse(int element, std::string_view what, std::string_view got,
                         std::string_view expected, int line) const {
  models::internal::RefuseText(file_, line > 0 ? line : elements_[element].line, what, got,
                               expected);
}

}  // namespace oca::geometry::internal
