// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/diagram.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "oca/framework/dataflow/check_name.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/dataflow/schedule_compiler.h"
#include "oca/framework/dataflow/wiring.h"

namespace oca {
namespace {

/// A port that `find` finds in a system; what it lacks is told with the system's path.
template <class Find>
auto InSystemOf(const std::string& path, const Find& find) {
  try {
    return find();
  } catch (const WiringError& error) {
    throw WiringError(fmt::format("{}: {}", path.substr(0, path.rfind('.')), error.what()));
  }
}

/// An input that a diagram, or one nested in it, exports; its own name may have dots.
std::optional<InputHandle> FindExported(const Diagram& diagram, const std::string& path) {
  for (int i = 0; i < std::ssize(diagram.inputs()); ++i) {
    if (diagram.inputs()[i].name == path) return InputHandle{{&diagram, i}};
  }
  const std::size_t dot = path.find('.');
  if (dot == std::string::npos) return std::nullopt;
  const auto* nested = dynamic_cast<const Diagram*>(diagram.FindSystem(path.substr(0, dot)));
  return nested == nullptr ? std::nullopt : FindExported(*nested, path.substr(dot + 1));
}

/// Of all systems inside, nested diagrams included.
void AddPaths(const Diagram& diagram, const std::string& prefix, std::vector<std::string>& paths) {
  for (const Diagram::Child& child : diagram.children()) {
    paths.push_back(prefix + child.name);
    const auto* nested = dynamic_cast<const Diagram*>(child.system.get());
    if (nested != nullptr) AddPaths(*nested, paths.back() + ".", paths);
  }
}

}  // namespace

Diagram::Diagram() = default;
Diagram::~Diagram() = default;

const Schedule& Diagram::schedule() const {
  if (own_schedule_ == nullptr) {
    throw WiringError("diagram: it is nested in another one, whose root makes the contexts");
  }
  return *own_schedule_;
}

Context Diagram::MakeContext() const { return Context(&schedule()); }

std::pair<const System*, std::string> Diagram::SplitPath(const std::string& path,
                                                         const char* kind) const {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) return {this, path};
  const System* const system = FindSystem(path.substr(0, dot));
  if (system != nullptr) return {system, path.substr(dot + 1)};
  std::vector<std::string> names;
  AddPaths(*this, "", names);
  const std::string got = path.substr(0, dot);
  throw WiringError(fmt::format("no {} port '{}': no system '{}'{}; systems are: {}", kind, path,
                                got, DidYouMean(got, names), fmt::join(names, ", ")));
}

InputHandle Diagram::FindInput(const std::string& path) const {
  if (const auto exported = FindExported(*this, path)) return *exported;
  const auto found = SplitPath(path, "input");
  if (found.first == this) return System::FindInput(found.second);
  return InSystemOf(path, [&] { return found.first->FindInput(found.second); });
}

OutputHandle Diagram::FindOutput(const std::string& path) const {
  const auto found = SplitPath(path, "output");
  if (found.first != this) {
    return InSystemOf(path, [&] { return found.first->FindOutput(found.second); });
  }
  return exported_outputs_[System::FindOutput(found.second).index].second;
}

const System* Diagram::FindSystem(const std::string& path) const {
  const std::size_t dot = path.find('.');
  for (const Child& child : children_) {
    if (child.name != path.substr(0, dot)) continue;
    if (dot == std::string::npos) return child.system.get();
    const auto* nested = dynamic_cast<const Diagram*>(child.system.get());
    return nested == nullptr ? nullptr : nested->FindSystem(path.substr(dot + 1));
  }
  return nullptr;
}

void Diagram::SetRoot(const Diagram* root) {
  root_ = root;
  for (const Child& child : children_) {
    if (auto* nested = dynamic_cast<Diagram*>(child.system.get())) nested->SetRoot(root);
  }
}

const Wiring& Diagram::wiring() const {
  if (root_ != nullptr) return *root_->own_wiring_;
  throw WiringError("diagram: it is nested in another one, which has not been built");
}

DiagramBuilder::DiagramBuilder() : diagram_(new Diagram) {}
DiagramBuilder::~DiagramBuilder() = default;

void DiagramBuilder::ThrowOfSystem(const std::string& name) {
  try {
    throw;
  } catch (WiringError& error) {
    for (WiringProblem& problem : error.problems) {
      problem.text.insert(problem.text.begin(), name + ": ");
    }
    throw WiringError(std::move(error.problems));
  } catch (Error& error) {
    error.AddWhere(name);
    throw;
  }
}

const System& DiagramBuilder::AddSystem(std::string name, std::unique_ptr<System> system) {
  internal::CheckName(name, "system");
  if (system == nullptr) {
    throw WiringError(fmt::format("system '{}': got nothing; expected a system", name));
  }
  for (const Diagram::Child& child : diagram_->children_) {
    if (child.name == name) {
      throw WiringError(fmt::format("system name: '{}' is taken", name));
    }
  }
  if (auto* nested = dynamic_cast<Diagram*>(system.get())) {
    nested->SetRoot(nullptr);
    nested->own_wiring_.reset();
    nested->own_schedule_.reset();
    nested->schedule_ = nullptr;  // another schedule may come to lie where that one was
  }
  const System& reference = *system;
  diagram_->children_.push_back({std::move(name), std::move(system)});
  return reference;
}

void DiagramBuilder::ConnectPorts(const OutputHandle& from, const InputHandle& to) {
  diagram_->connections_.push_back({from, to});
}

void DiagramBuilder::ExportInput(std::string name, const InputHandle& input, int size) {
  internal::CheckPath(name, "input");
  if (input.system == nullptr) {
    throw WiringError(fmt::format(
        "exported input '{}': got a handle that was made by default; expected an input", name));
  }
  auto& exported = diagram_->exported_inputs_;
  const auto same = std::find_if(exported.begin(), exported.end(),
                                 [&](const auto& other) { return other.name == name; });
  if (same != exported.end()) {
    same->to.push_back(input);
    return;
  }
  System::InputInfo info = input.system->inputs().at(input.index);
  info.name = name;
  diagram_->inputs_.push_back(std::move(info));
  exported.push_back({std::move(name), {input}, size});
}

void DiagramBuilder::ExportOutput(std::string name, const OutputHandle& output) {
  internal::CheckName(name, "output");
  for (const auto& other : diagram_->exported_outputs_) {
    if (other.first == name) {
      throw WiringError(fmt::format("output name: '{}' is exported twice", name));
    }
  }
  if (output.system == nullptr) {
    throw WiringError(fmt::format(
        "exported output '{}': got a handle that was made by default; expected an output", name));
  }
  const System::OutputInfo& inner = output.system->outputs().at(output.index);
  diagram_->AddOutput({name, inner.type, inner.spec, {}, -1});
  diagram_->exported_outputs_.emplace_back(std::move(name), output);
}

std::unique_ptr<Diagram> DiagramBuilder::Build() {
  auto wiring = std::make_unique<Wiring>(*diagram_);
  diagram_->own_schedule_ = ScheduleCompiler::Compile(*diagram_, *wiring);
  diagram_->own_wiring_ = std::move(wiring);
  diagram_->SetRoot(diagram_.get());
  return std::exchange(diagram_, std::unique_ptr<Diagram>(new Diagram));
}

std::unique_ptr<Diagram> DiagramBuilder::BuildInner() {
  return std::exchange(diagram_, std::unique_ptr<Diagram>(new Diagram));
}

std::unique_ptr<Diagram> MakeDiagramOf(std::unique_ptr<System> system,
                                       const std::map<std::string, int>& sizes) {
  DiagramBuilder builder;
  const System& added = builder.AddSystem("system", std::move(system));
  for (const System::InputInfo& input : added.inputs()) {
    const auto size = sizes.find(input.name);
    if (input.optional && size == sizes.end()) continue;
    builder.ExportInput(input.name, added.FindInput(input.name),
                        size == sizes.end() ? -1 : size->second);
  }
  for (const System::OutputInfo& output : added.outputs()) {
    builder.ExportOutput(output.name, added.FindOutput(output.name));
  }
  return builder.Build();
}

}  // namespace oca
