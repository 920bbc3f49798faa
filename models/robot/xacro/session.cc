// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/xacro/session.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml.h>

#include <algorithm>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/file_cache.h"
#include "oca/models/nearest_name.h"
#include "oca/models/robot/xacro/scope.h"
#include "oca/models/robot/xacro/text_parts.h"
#include "oca/models/robot/xacro/yaml_values.h"
#include "oca/models/robot/xml_file.h"
#include "oca/models/table_text.h"

namespace oca::robot::xacro {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostYaml = 5'000'000;

/// Names no properties and functions: of the expressions in YAML.
class NoNames final : public Surroundings {
 public:
  const PythonValue* Property(const std::string& /*name*/) override { return nullptr; }
  Surroundings* Namespace(const std::string& /*name*/) override { return nullptr; }
  PythonValue CallXacro(const std::string& name, const Arguments& /*arguments*/) override {
    throw Mistake("function", "xacro." + name, "arithmetic");
  }
  std::vector<std::string> PropertyNames() const override { return {}; }
};

std::string TextOf(const std::string& name, const Arguments& arguments) {
  std::string text;
  for (const PythonValue& value : arguments.values)
    text += (text.empty() ? "" : " ") + ToText(value);
  if (!arguments.named.empty()) {
    throw Mistake(name + "()", arguments.named[0].first + "=", "arguments without names");
  }
  return text;
}

/// xacro.tokenize(text, separators=',; ', skip_empty=True)
PythonValue Tokens(const Arguments& arguments) {
  CheckCount("tokenize()", arguments, 1, 3);
  const std::string& text = TextArgument("tokenize()", arguments, 0);
  const std::string separators =
      arguments.values.size() > 1 ? TextArgument("tokenize()", arguments, 1) : ",; ";
  const bool skip = arguments.values.size() < 3 || arguments.values[2].truth();
  PythonValue::Items items;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(separators, from), text.size());
    if (end > from || !skip) items.emplace_back(text.substr(from, end - from));
    from = end + 1;
  }
  return PythonValue::ListOf(std::move(items));
}

}  // namespace

Session::Session(const XacroOptions& options) : options_(options), arguments_(options.arguments) {}

PythonValue Session::Evaluate(const std::string& text, Scope& scope, const SourcePlace& place) {
  const Budget::Level level(budget_);
  budget_.Spend(text.size() + 1);
  std::string joined;
  TextParts parts(text);
  bool first = true;
  for (TextPart part = parts.Next(); part.kind != TextPart::Kind::kEnd; part = parts.Next()) {
    PythonValue value = part.kind == TextPart::Kind::kExpression
                            ? EvaluateExpression(part.text, scope, place)
                        : part.kind == TextPart::Kind::kSubstitution
                            ? PythonValue(Substitute(part.text, scope, place))
                            : PythonValue(part.text);
    if (first && parts.AtEnd()) return value;
    first = false;
    joined += ToText(value);
    if (joined.size() > kMostText) {
      throw Mistake("length of a text", fmt::format("more than {} bytes", kMostText), "fewer");
    }
  }
  budget_.Spend(joined.size());
  return PythonValue(std::move(joined));
}

PythonValue Session::EvaluateExpression(const std::string& text, Scope& scope,
                                        const SourcePlace& place) {
  // ${...} and $(...) inside of an expression are put in as texts before it is read.
  PythonValue inner = Evaluate(text, scope, place);
  if (inner.text() == nullptr) return inner;
  const SourcePlace* const outer = std::exchange(at_, &place);
  try {
    PythonValue value = xacro::Evaluate(*ParseExpression(*inner.text()), scope, budget_);
    at_ = outer;
    return value;
  } catch (const Mistake& mistake) {
    at_ = outer;
    const std::string shown = text.size() > 100 ? text.substr(0, 100) + "..." : text;
    if (std::string_view(mistake.what()).size() > 1000) throw;
    throw Mistake(fmt::format("${{{}}}: {}", shown, mistake.what()));
  } catch (...) {
    at_ = outer;
    throw;
  }
}

std::string Session::Substitute(const std::string& text, Scope& scope, const SourcePlace& place) {
  const std::string inner = ToText(Evaluate(text, scope, place));
  const std::vector<std::string_view> words = models::internal::Words(inner);
  const std::string command(words.empty() ? "" : words[0]);
  const std::string rest =
      words.size() < 2
          ? ""
          : inner.substr(static_cast<std::size_t>(words[1].data() - inner.data()),
                         static_cast<std::size_t>(words.back().data() + words.back().size() -
                                                  words[1].data()));
  if (command == "arg" && words.size() == 2) return ArgumentNamed(rest);
  if (command == "find" && words.size() == 2) return PackageFolder(rest);
  if (command == "dirname" && words.size() == 1) {
    return fs::absolute(*place.file).parent_path().lexically_normal().string();
  }
  if (command == "optenv" && words.size() >= 2) {
    // The environment of whoever runs this must not get into a robot that somebody else wrote.
    return words.size() == 2
               ? ""
               : inner.substr(static_cast<std::size_t>(words[2].data() - inner.data()));
  }
  if (command == "env" || command == "cwd" || command == "anon" || command == "eval") {
    throw Mistake("substitution", fmt::format("$({})", inner),
                  "$(arg NAME), $(find PACKAGE), $(dirname), $(optenv NAME DEFAULT), of which the "
                  "default counts, or ${...}: the environment has no say in a robot");
  }
  throw Mistake("substitution", fmt::format("$({})", inner),
                "$(arg NAME), $(find PACKAGE), $(dirname) or $(optenv NAME DEFAULT)");
}

const std::string& Session::ArgumentNamed(const std::string& name) {
  const auto found = arguments_.find(name);
  if (found == arguments_.end()) {
    std::vector<std::string> known;
    for (const auto& entry : arguments_) known.push_back(entry.first);
    const std::string nearest = models::NearestName(name, known);
    throw Mistake("argument", fmt::format("'{}', which has no value here", name),
                  fmt::format("one that is given or has a <xacro:arg> before{}",
                              nearest.empty() ? "" : fmt::format(", such as '{}'", nearest)));
  }
  declared_.insert(name);
  return found->second;
}

void Session::CheckArguments() const {
  for (const auto& entry : options_.arguments) {
    if (declared_.contains(entry.first)) continue;
    const std::vector<std::string> known(declared_.begin(), declared_.end());
    const std::string nearest = models::NearestName(entry.first, known);
    throw Mistake("unknown argument", fmt::format("'{}'", entry.first),
                  nearest.empty() ? "none: the file has no <xacro:arg>"
                                  : fmt::format("one of the file such as '{}' (they are {})",
                                                nearest, fmt::join(known, ", ")));
  }
}

std::string Session::PackageFolder(const std::string& package) const {
  if (options_.find_package) {
    const fs::path found = options_.find_package(package);
    if (!found.empty()) return fs::absolute(found).lexically_normal().string();
  }
  std::string places;
  for (const fs::path& folder : options_.package_directories) {
    std::error_code error;
    if (fs::is_directory(folder / package, error)) {
      return fs::absolute(folder / package).lexically_normal().string();
    }
    places += (places.empty() ? "" : " or ") + folder.string();
  }
  throw Mistake(
      "package", fmt::format("'{}'", package),
      fmt::format("one that is known{}{}", places.empty() ? "" : " or a folder in " + places,
                  options_.package_advice));
}

fs::path Session::PathOf(const std::string& name, const SourcePlace& place) const {
  if (name.empty()) throw Mistake("file", "an empty name", "one of a file");
  if (name.starts_with("package://")) {
    const std::string rest = name.substr(10);
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    return fs::path(PackageFolder(rest.substr(0, slash))) /
           rest.substr(std::min(slash + 1, rest.size()));
  }
  const fs::path path = name.starts_with("file://") ? name.substr(7) : name;
  return (fs::path(*place.file).parent_path() / path).lexically_normal();
}

NodePtr Session::Read(const fs::path& file) {
  budget_.CountFile();
  const auto found = files_.find(file);
  if (found != files_.end()) return found->second;
  const std::string text = ReadXmlFile(file);
  budget_.Spend(text.size());
  const XmlDocument document = ParseXml(text, file.string());
  return files_[file] =
             ReadNode(*document->RootElement(), std::make_shared<const std::string>(file.string()));
}

PythonValue Session::LoadYaml(const std::string& name) {
  const fs::path file = PathOf(name, *at_);
  budget_.CountFile();
  const auto found = yaml_.find(file);
  if (found != yaml_.end()) return found->second;
  std::string text;
  try {
    text = *models::ReadOnce<std::string>(file, "YAML", [&] { return models::ReadFile(file); });
  } catch (const models::ModelError& error) {
    throw Mistake(error.what());
  }
  if (text.size() > kMostYaml) {
    throw Mistake("size of " + file.string(), fmt::format("{} bytes", text.size()),
                  fmt::format("at most {}", kMostYaml));
  }
  budget_.Spend(text.size());
  NoNames names;
  try {
    return yaml_[file] = ReadYamlValues(text, [&](const std::string& expression) {
             return xacro::Evaluate(*ParseExpression(expression), names, budget_);
           });
  } catch (const Mistake& mistake) {
    throw Mistake(fmt::format("{}:{}", file.string(), mistake.what()));
  }
}

PythonValue Session::CallXacro(const std::string& name, const Arguments& arguments) {
  const std::string what = "xacro." + name + "()";
  if (name == "tokenize") return Tokens(arguments);
  if (name == "message" || name == "warning" || name == "error" || name == "print_location") {
    if (name != "print_location") Warn(*at_, TextOf(name, arguments));
    return PythonValue(std::string());
  }
  if (name == "fatal")
    throw Mistake("xacro.fatal", TextOf(name, arguments), "what the file asks for");
  const bool known =
      std::find(kXacroFunctions.begin(), kXacroFunctions.end(), name) != kXacroFunctions.end();
  if (!known) {
    throw Mistake("unknown function", what,
                  fmt::format("one of xacro.{}", fmt::join(kXacroFunctions, ", xacro.")));
  }
  CheckCount(what, arguments, 1, 1);
  if (name == "dotify") return arguments.values[0];
  const std::string& text = TextArgument(what, arguments, 0);
  if (name == "arg") return PythonValue(ArgumentNamed(text));
  if (name == "abs_filename") return PythonValue(fs::absolute(PathOf(text, *at_)).string());
  return LoadYaml(text);
}

void Session::Warn(const SourcePlace& place, const std::string& text) const {
  if (options_.warn) options_.warn(fmt::format("{}: {}", place.ToString(), text));
}

}  // namespace oca::robot::xacro
