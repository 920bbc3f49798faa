// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/connection_section.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/diagrams/loading/connection_pattern.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"

namespace oca::loading {
namespace {

/// The name behind `inputs.` or `outputs.`; empty if the path is another.
std::string NameBehind(std::string_view ports, const std::string& path) {
  return path.starts_with(ports) ? path.substr(ports.size()) : std::string();
}

std::string Trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  const auto last = text.find_last_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, last - first + 1));
}

/// Whether the name of a port is this one, or a pattern that begins as this one does.
bool CanStandFor(const std::string& port, const std::string& name) {
  return port == name || (IsPattern(port) && name.starts_with(port.substr(0, port.find('<'))));
}

}  // namespace

bool TakesIn(const Value& root, const std::string& input) {
  const Value* const value = root.Find("connections");
  if (value == nullptr || value->list() == nullptr) return false;
  return std::any_of(value->list()->begin(), value->list()->end(), [&](const Value& item) {
    const std::string* const text = item.string();
    const std::size_t arrow = text == nullptr ? std::string::npos : text->find("->");
    if (arrow == std::string::npos) return false;
    const std::string from = NameBehind(kInputs, Trimmed(text->substr(0, arrow)));
    const std::string to = Trimmed(text->substr(arrow + 2));
    return !from.empty() &&
           (CanStandFor(from, input) || CanStandFor(to.substr(to.rfind('.') + 1), input));
  });
}

ConnectionSection::ConnectionSection(const Value& root, const Level& level,
                                     const SystemSection& systems, Construction& construction,
                                     DiagramBuilder& builder, Problems& problems)
    : level_(level),
      systems_(systems),
      construction_(construction),
      builder_(builder),
      problems_(problems) {
  const Value* const value = root.Find("connections");
  if (value == nullptr || value->null()) return;
  if (value->list() == nullptr) {
    problems_.Add(value->location(), fmt::format("connections: got {}; expected a list of "
                                                 "'system.output -> system.input'",
                                                 value->Show()));
    return;
  }
  for (const Value& item : *value->list()) Read(item);
  CheckShownInputs();
}

/// What the file leaves to another one it must not drive itself.
void ConnectionSection::CheckShownInputs() {
  if (level_.path.empty()) return;  // Build finds it
  for (const auto& [name, targets] : inputs_) {
    for (const InputAt& target : targets) {
      const auto own = construction_.connections.find(target.path);
      if (own == construction_.connections.end()) continue;
      problems_.Add(own->second.location,
                    fmt::format("{}: two drivers; got this and inputs.{}; expected one",
                                PathIn(level_.path, target.path), name));
    }
  }
}

void ConnectionSection::Read(const Value& item) {
  if (item.null()) return;
  const std::string* const text = item.string();
  const std::size_t arrow = text == nullptr ? std::string::npos : text->find("->");
  if (arrow == std::string::npos) {
    problems_.Add(
        item.location(),
        fmt::format("connections: got {}; expected 'system.output -> system.input'", item.Show()));
    return;
  }
  const Location& location = item.location();
  const std::string from = ReadPort(std::string_view(*text).substr(0, arrow), location);
  const std::string to = ReadPort(std::string_view(*text).substr(arrow + 2), location);
  if (from.empty() || to.empty()) return;
  if (!IsPattern(from) && !IsPattern(to)) return Connect(from, to, location);
  const auto all = MatchConnections(from, to, systems_.OutputNames(), systems_.InputNames());
  for (const auto& [output, input] : all) Connect(output, input, location);
  const bool shows_what_is_there = from.starts_with(kInputs) && IsPattern(from);
  if (all.empty() && !shows_what_is_there) {
    construction_.warnings.Add(
        level_.path,
        {location, fmt::format("connections: {} -> {}: no ports have such names", from, to),
         Diagnostic::Kind::kWarning});
  }
}

/// `system.port`; empty, with a problem, if it is something else.
std::string ConnectionSection::ReadPort(std::string_view text, const Location& location) {
  std::string port = Trimmed(text);
  const std::size_t dot = port.find('.');
  const bool port_of_system = dot != std::string::npos && dot != 0 && port.back() != '.';
  if (port_of_system && !IsAmbiguous(port)) return port;
  problems_.Add(location,
                fmt::format("connections: got '{}'; expected {}", port,
                            port_of_system ? "a dot between two places for names" : "system.port"));
  return "";
}

void ConnectionSection::Connect(const std::string& from, const std::string& to,
                                const Location& location) {
  if (!made_.insert(from + " -> " + to).second) return;
  const std::string input = NameBehind(kInputs, from);
  const std::string output = NameBehind(kOutputs, to);
  try {
    if (!input.empty() && !output.empty()) {
      problems_.Add(location,
                    fmt::format("connections: {} -> {}: got an input of the file; expected "
                                "an output of a system",
                                from, to));
    } else if (!input.empty()) {
      ShowInput(input, to, location);
    } else if (!output.empty()) {
      ShowOutput(from, output, location);
    } else {
      const auto there = systems_.FindOutput(from);
      const auto here = systems_.FindInputs(to);
      if (!there || !here) return;
      for (const InputAt& target : *here) ConnectPorts(*there, target, location);
    }
  } catch (const WiringError& error) {
    problems_.Add(location, fmt::format("connections: {}", error.what()));
  }
}

void ConnectionSection::ShowInput(const std::string& name, const std::string& to,
                                  const Location& location) {
  const auto targets = systems_.FindInputs(to);
  if (!targets) return;
  for (const InputAt& target : *targets) {
    inputs_[name].push_back(target);
    if (!level_.path.empty() || !target.built) continue;
    builder_.ExportInput(name, target.handle);
    construction_.connections[target.path] = {location, level_.path};
  }
}

void ConnectionSection::ShowOutput(const std::string& from, const std::string& name,
                                   const Location& location) {
  const auto output = systems_.FindOutput(from);
  if (!output) return;
  const auto [shown, fresh] = outputs_.emplace(name, *output);
  if (!fresh) {
    problems_.Add(location, fmt::format("connections: outputs.{}: two drivers; got {} and {}; "
                                        "expected one",
                                        name, PathIn(level_.path, shown->second.path),
                                        PathIn(level_.path, output->path)));
  } else if (level_.path.empty() && construction_.part.whole()) {
    builder_.ExportOutput(name, output->handle);
  }
}

void ConnectionSection::ConnectPorts(const OutputAt& from, const InputAt& to,
                                     const Location& location) {
  if (!to.built) return;
  if (from.built) {
    builder_.ConnectPorts(from.handle, to.handle);
  } else {
    Import(from, to, location);
  }
  construction_.connections[to.path] = {location, level_.path};
  construction_.open.erase(to.path);
}

/// Exports an input of the part under the path of the output outside that drives it.
void ConnectionSection::Import(const OutputAt& from, const InputAt& to, const Location& location) {
  const SignalType& got = TypeOfPort(from.handle);
  const SignalType& expected = TypeOfPort(to.handle);
  if (&got != &expected) {
    problems_.Add(location,
                  fmt::format("{} -> {}: type; got {}; expected {}", PathIn(level_.path, from.path),
                              PathIn(level_.path, to.path), got.name, expected.name));
  } else {
    construction_.root.ExportInput(from.path, to.handle);
  }
}

}  // namespace oca::loading
