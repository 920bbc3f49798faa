// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/connection_section.h"

#include <fmt/format.h>

#include "oca/diagrams/loading/loaded_diagram.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"

namespace oca::loading {

ConnectionSection::ConnectionSection(const Value& root, const Part& part,
                                     const SystemSection& systems, DiagramBuilder& builder,
                                     Problems& problems)
    : part_(part), systems_(systems), builder_(builder), problems_(problems) {
  const Value* const value = root.Find("connections");
  if (value == nullptr || value->null()) return;
  if (value->list() == nullptr) {
    problems_.Add(value->location(), fmt::format("connections: got {}; expected a list of "
                                                 "'system.output -> system.input'",
                                                 value->Show()));
    return;
  }
  for (const Value& item : *value->list()) Read(item);
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
  const auto from = SplitPort(text->substr(0, arrow), item.location());
  const auto to = SplitPort(text->substr(arrow + 2), item.location());
  if (!from || !to) return;
  try {
    Connect(*from, *to, item.location());
  } catch (const WiringError& error) {
    problems_.Add(item.location(), error.what());
  }
}

std::optional<ConnectionSection::PortName> ConnectionSection::SplitPort(std::string text,
                                                                        const Location& location) {
  const auto first = text.find_first_not_of(" \t");
  const auto last = text.find_last_not_of(" \t");
  text = first == std::string::npos ? "" : text.substr(first, last - first + 1);
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == text.size()) {
    problems_.Add(location, fmt::format("connections: got '{}'; expected system.port", text));
    return std::nullopt;
  }
  return PortName{text.substr(0, dot), text.substr(dot + 1)};
}

void ConnectionSection::Connect(const PortName& from, const PortName& to,
                                const Location& location) {
  OutputHandle output;
  InputHandle input;
  const bool from_there =
      Locate(from, location, [&](const System& system) { output = system.FindOutput(from.port); });
  const bool to_there =
      Locate(to, location, [&](const System& system) { input = system.FindInput(to.port); });
  if (!from_there || !to_there || !part_.Has(to.system)) return;
  if (part_.Has(from.system)) {
    builder_.ConnectPorts(output, input);
  } else {
    Import(from, output, input, location);
  }
  locations_[to.system + "." + to.port] = location;
}

/// Calls find(system); adds a problem if the system or the port does not exist.
template <class Find>
bool ConnectionSection::Locate(const PortName& name, const Location& location, const Find& find) {
  const System* const system = systems_.Find(name.system);
  if (system == nullptr) {
    if (!systems_.Names(name.system)) {  // one that is named but not made has been reported
      problems_.Add(location, fmt::format("connections: no system '{}'{}", name.system,
                                          DidYouMean(name.system, systems_.names())));
    }
    return false;
  }
  try {
    find(*system);
    return true;
  } catch (const WiringError& error) {
    problems_.Add(location, fmt::format("connections: {}: {}", name.system, error.what()));
    return false;
  }
}

/// Exports an input of the part under the name of the output outside that drives it.
void ConnectionSection::Import(const PortName& from, const OutputHandle& output,
                               const InputHandle& input, const Location& location) {
  const SignalType& got = TypeOfPort(output);
  const SignalType& expected = TypeOfPort(input);
  const std::string port = from.system + "." + from.port;
  const std::string name = ExportedName(port);
  const auto [imported, fresh] = imports_.emplace(name, port);
  if (!fresh && imported->second != port) {
    problems_.Add(location, fmt::format("part: {} and {} would both become the input {}",
                                        imported->second, port, name));
  } else if (&got != &expected) {
    problems_.Add(location,
                  fmt::format("{} -> {}: type; got {}; expected {}", port,
                              input.system->inputs()[input.index].name, got.name, expected.name));
  } else {
    builder_.ExportInput(name, input);
  }
}

const Location* ConnectionSection::LocationOf(const std::string& problem) const {
  for (const auto& [input, location] : locations_) {
    if (problem.find("-> " + input + ":") != std::string::npos ||
        problem.starts_with(input + ":")) {
      return &location;
    }
  }
  return nullptr;
}

}  // namespace oca::loading
