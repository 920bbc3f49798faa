// SPDX-License-Identifier: BSD-3-Clause
// Methods of texts, lists and dictionaries, of functions.h.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "oca/models/robot/xacro/functions.h"

namespace oca::robot::xacro {
namespace {

constexpr std::array kTextMethods = {
    "split",    "rsplit",     "join",    "replace",   "strip", "lstrip",  "rstrip",    "lower",
    "upper",    "capitalize", "title",   "find",      "rfind", "index",   "count",     "startswith",
    "endswith", "isdigit",    "isalpha", "isnumeric", "zfill", "__len__", "splitlines"};
constexpr std::array kListMethods = {"index", "count", "__len__"};
constexpr std::array kDictMethods = {"keys",    "values", "items",  "get",
                                     "has_key", "copy",   "__len__"};
constexpr std::string_view kBlank = " \t\r\n\f\v";

template <class Names>
bool IsIn(const Names& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

PythonValue Size(std::size_t size) { return PythonValue(static_cast<std::int64_t>(size)); }

std::string Stripped(const std::string& text, std::string_view of, bool left, bool right) {
  const std::size_t from = left ? text.find_first_not_of(of) : 0;
  if (from == std::string::npos) return "";
  const std::size_t last = right ? text.find_last_not_of(of) : text.size() - 1;
  return last == std::string::npos ? "" : text.substr(from, last + 1 - from);
}

PythonValue::Items SplitAtBlanks(const std::string& text, std::int64_t most) {
  PythonValue::Items items;
  std::size_t at = text.find_first_not_of(kBlank);
  while (at != std::string::npos) {
    if (most >= 0 && std::ssize(items) == most) {
      items.emplace_back(Stripped(text.substr(at), kBlank, false, true));
      break;
    }
    const std::size_t end = std::min(text.find_first_of(kBlank, at), text.size());
    items.emplace_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBlank, end);
  }
  return items;
}

PythonValue::Items SplitAt(const std::string& text, const std::string& separator, std::int64_t most,
                           bool from_right) {
  PythonValue::Items items;
  std::size_t from = 0, to = text.size();
  while (most < 0 || std::ssize(items) < most) {
    if (items.size() >= kMostItems) throw Mistake("split()", "too many parts", "fewer");
    if (from_right) {
      const std::size_t found =
          to < separator.size() ? std::string::npos : text.rfind(separator, to - separator.size());
      if (found == std::string::npos) break;
      items.emplace_back(text.substr(found + separator.size(), to - found - separator.size()));
      to = found;
    } else {
      const std::size_t found = text.find(separator, from);
      if (found == std::string::npos) break;
      items.emplace_back(text.substr(from, found - from));
      from = found + separator.size();
    }
  }
  items.emplace_back(text.substr(from, to - from));
  if (from_right) std::reverse(items.begin(), items.end());
  return items;
}

PythonValue Split(const std::string& text, const std::string& name, const Arguments& arguments) {
  CheckCount(name + "()", arguments, 0, 2);
  std::int64_t most = -1;
  if (arguments.values.size() == 2) {
    if (!arguments.values[1].is_whole()) {
      throw Mistake(name + "()", Shown(arguments.values[1]), "a whole number");
    }
    most = arguments.values[1].whole();
  }
  if (arguments.values.empty() || arguments.values[0].none()) {
    if (name == "rsplit" && most >= 0) {
      throw Mistake("rsplit()", "a limit without a separator", "a separator first");
    }
    return PythonValue::ListOf(SplitAtBlanks(text, most));
  }
  const std::string& separator = TextArgument(name + "()", arguments, 0);
  if (separator.empty()) throw Mistake(name + "()", "''", "a separator");
  return PythonValue::ListOf(SplitAt(text, separator, most, name == "rsplit"));
}

PythonValue Joined(const std::string& separator, const Arguments& arguments) {
  CheckCount("join()", arguments, 1, 1);
  const auto* const list = arguments.values[0].list();
  if (list == nullptr) throw Mistake("join()", Shown(arguments.values[0]), "a list of texts");
  std::string text;
  for (std::size_t i = 0; i < list->items.size(); ++i) {
    const std::string* const item = list->items[i].text();
    if (item == nullptr) throw Mistake("join()", Shown(list->items[i]), "a text");
    if (i > 0) text += separator;
    text += *item;
    if (text.size() > kMostText) throw Mistake("join()", "a text above 1 MB", "a shorter one");
  }
  return PythonValue(std::move(text));
}

PythonValue Replaced(const std::string& text, const Arguments& arguments) {
  CheckCount("replace()", arguments, 2, 2);
  const std::string& old = TextArgument("replace()", arguments, 0);
  const std::string& fresh = TextArgument("replace()", arguments, 1);
  if (old.empty()) throw Mistake("replace()", "''", "a text to be replaced");
  std::string result;
  std::size_t from = 0;
  for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, from)) {
    result.append(text, from, at - from).append(fresh);
    from = at + old.size();
    if (result.size() > kMostText) throw Mistake("replace()", "a text above 1 MB", "a shorter one");
  }
  return PythonValue(result.append(text, from, std::string::npos));
}

PythonValue Found(const std::string& text, const std::string& name, const Arguments& arguments) {
  CheckCount(name + "()", arguments, 1, 1);
  const std::string& part = TextArgument(name + "()", arguments, 0);
  if (name == "count") {
    if (part.empty()) throw Mistake("count()", "''", "a text");
    std::int64_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos;
         at = text.find(part, at + part.size())) {
      ++count;
    }
    return PythonValue(count);
  }
  const std::size_t at = name == "rfind" ? text.rfind(part) : text.find(part);
  if (at == std::string::npos) {
    if (name == "index") throw Mistake("index()", Shown(PythonValue(part)), "a text that is in it");
    return PythonValue(std::int64_t{-1});
  }
  return Size(CharacterOffsets(text.substr(0, at)).size() - 1);
}

/// What letters beyond ASCII are, in which case, is not known here.
void RequireAscii(const std::string& what, const std::string& text) {
  if (std::all_of(text.begin(), text.end(), [](char c) { return (c & 0x80) == 0; })) return;
  throw Mistake(what, Shown(PythonValue(text)), "characters of ASCII");
}

std::string Cased(std::string text, const std::string& name) {
  RequireAscii(name + "()", text);
  bool first = true;
  for (char& c : text) {
    const bool letter = std::isalpha(static_cast<unsigned char>(c)) != 0;
    const bool upper = name == "upper" || (first && name != "lower");
    c = static_cast<char>(upper ? std::toupper(static_cast<unsigned char>(c))
                                : std::tolower(static_cast<unsigned char>(c)));
    first = name == "title" ? !letter : false;
  }
  return text;
}

PythonValue ZeroFilled(const std::string& text, const Arguments& arguments) {
  CheckCount("zfill()", arguments, 1, 1);
  const PythonValue& width = arguments.values[0];
  if (!width.is_whole() || width.whole() > 1000) {
    throw Mistake("zfill()", Shown(width), "a whole number up to 1000");
  }
  const auto least = static_cast<std::size_t>(std::max<std::int64_t>(width.whole(), 0));
  const std::size_t size = CharacterOffsets(text).size() - 1;
  if (size >= least) return PythonValue(text);
  const std::size_t sign = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  return PythonValue(text.substr(0, sign) + std::string(least - size, '0') + text.substr(sign));
}

PythonValue CallOfText(const std::string& text, const std::string& name,
                       const Arguments& arguments) {
  const std::string what = name + "()";
  if (name == "split" || name == "rsplit") return Split(text, name, arguments);
  if (name == "join") return Joined(text, arguments);
  if (name == "replace") return Replaced(text, arguments);
  if (name == "zfill") return ZeroFilled(text, arguments);
  if (name == "find" || name == "rfind" || name == "index" || name == "count") {
    return Found(text, name, arguments);
  }
  if (name.ends_with("strip")) {
    CheckCount(what, arguments, 0, 1);
    const std::string of =
        arguments.values.empty() ? std::string(kBlank) : TextArgument(what, arguments, 0);
    RequireAscii(what, of);
    return PythonValue(Stripped(text, of, name != "rstrip", name != "lstrip"));
  }
  if (name == "startswith" || name == "endswith") {
    CheckCount(what, arguments, 1, 1);
    const std::string& part = TextArgument(what, arguments, 0);
    return PythonValue(name == "startswith" ? text.starts_with(part) : text.ends_with(part));
  }
  CheckCount(what, arguments, 0, 0);
  if (name == "__len__") return Size(CharacterOffsets(text).size() - 1);
  if (name == "splitlines") {
    PythonValue::Items lines = SplitAt(text, "\n", -1, false);
    if (lines.back().text()->empty()) lines.pop_back();
    return PythonValue::ListOf(std::move(lines));
  }
  if (name.starts_with("is")) {
    RequireAscii(what, text);
    const auto fits = [&](char c) {
      const auto byte = static_cast<unsigned char>(c);
      return name == "isalpha" ? std::isalpha(byte) != 0 : std::isdigit(byte) != 0;
    };
    return PythonValue(!text.empty() && std::all_of(text.begin(), text.end(), fits));
  }
  return PythonValue(Cased(text, name));
}

PythonValue CallOfList(const PythonValue::Items& items, const std::string& name,
                       const Arguments& arguments) {
  if (name == "__len__") {
    CheckCount("__len__()", arguments, 0, 0);
    return Size(items.size());
  }
  CheckCount(name + "()", arguments, 1, 1);
  const auto same = [&](const PythonValue& item) { return Equal(item, arguments.values[0]); };
  if (name == "count") {
    return Size(static_cast<std::size_t>(std::count_if(items.begin(), items.end(), same)));
  }
  const auto found = std::find_if(items.begin(), items.end(), same);
  if (found == items.end()) {
    throw Mistake("index()", Shown(arguments.values[0]), "a value that is in the list");
  }
  return Size(static_cast<std::size_t>(found - items.begin()));
}

PythonValue CallOfDict(const PythonValue& of, const std::string& name, const Arguments& arguments) {
  const PythonValue::Dict& dict = *of.dict();
  if (name == "get") {
    CheckCount("get()", arguments, 1, 2);
    if (const PythonValue* const found = Find(dict, arguments.values[0])) return *found;
    return arguments.values.size() == 2 ? arguments.values[1] : PythonValue();
  }
  if (name == "has_key") {
    CheckCount("has_key()", arguments, 1, 1);
    return PythonValue(Find(dict, arguments.values[0]) != nullptr);
  }
  CheckCount(name + "()", arguments, 0, 0);
  if (name == "__len__") return Size(dict.entries.size());
  if (name == "copy") return of;
  PythonValue::Items items;
  for (const auto& [key, value] : dict.entries) {
    items.push_back(name == "keys"     ? key
                    : name == "values" ? value
                                       : PythonValue::ListOf({key, value}, true));
  }
  return PythonValue::ListOf(std::move(items));
}

template <class Names>
[[noreturn]] void FailMethod(const PythonValue& of, const std::string& name, const Names& known) {
  throw Mistake(fmt::format("method of {}", of.type()), fmt::format("'{}'", name),
                fmt::format("one of {}", fmt::join(known, ", ")));
}

}  // namespace

PythonValue CallMethod(const PythonValue& of, const std::string& name, const Arguments& arguments,
                       Budget& budget) {
  if (of.text() != nullptr) {
    if (!IsIn(kTextMethods, name)) FailMethod(of, name, kTextMethods);
    budget.Spend(of.text()->size());
    return CallOfText(*of.text(), name, arguments);
  }
  if (const auto* list = of.list()) {
    if (!IsIn(kListMethods, name)) FailMethod(of, name, kListMethods);
    return CallOfList(list->items, name, arguments);
  }
  if (of.dict() == nullptr) {
    throw Mistake(fmt::format("method '{}'", name), std::string(of.type()),
                  "a text, list or dictionary");
  }
  if (!IsIn(kDictMethods, name)) FailMethod(of, name, kDictMethods);
  return CallOfDict(of, name, arguments);
}

}  // namespace oca::robot::xacro
