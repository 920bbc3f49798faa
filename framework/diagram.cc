// SPDX-License-Identifier: BSD-3-Clause
#include "framework/diagram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "framework/error.h"
#include "framework/plan.h"
#include "framework/plan_compiler.h"

namespace oca {
namespace {

void CheckName(const std::string& name, const char* what) {
  const auto good = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  if (name.empty() || !std::all_of(name.begin(), name.end(), good)) {
    throw WiringError(
        {fmt::format("{} name: got '{}'; expected letters, digits and underscores", what, name)});
  }
}

}  // namespace

Diagram::Diagram() = default;
Diagram::~Diagram() = default;

const Plan& Diagram::plan() const {
  if (own_plan_ == nullptr) {
    throw WiringError({"diagram: it is nested in another one, whose root makes the contexts"});
  }
  return *own_plan_;
}

Context Diagram::MakeContext() const { return Context(&plan()); }

InputHandle Diagram::FindInput(const std::string& name) const { return System::FindInput(name); }

OutputHandle Diagram::FindOutput(const std::string& name) const {
  return exported_outputs_[System::FindOutput(name).index].second;
}

InputHandle Diagram::CheckedInput(const std::string& name, const SignalType& type) const {
  const InputHandle handle = System::FindInput(name);
  if (inputs()[handle.index].type != &type) {
    throw WiringError({fmt::format("input '{}': type; got {}; expected {}", name, type.name,
                                   inputs()[handle.index].type->name)});
  }
  return handle;
}

OutputHandle Diagram::CheckedOutput(const std::string& name, const SignalType& type) const {
  const int index = System::FindOutput(name).index;
  if (outputs()[index].type != &type) {
    throw WiringError({fmt::format("output '{}': type; got {}; expected {}", name, type.name,
                                   outputs()[index].type->name)});
  }
  return exported_outputs_[index].second;
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

DiagramBuilder::DiagramBuilder() : diagram_(new Diagram) {}
DiagramBuilder::~DiagramBuilder() = default;

const System& DiagramBuilder::AddSystem(std::string name, std::unique_ptr<System> system) {
  CheckName(name, "system");
  if (system == nullptr) {
    throw WiringError({fmt::format("system '{}': got nothing; expected a system", name)});
  }
  for (const Diagram::Child& child : diagram_->children_) {
    if (child.name == name) {
      throw WiringError({fmt::format("system name: '{}' is taken", name)});
    }
  }
  if (auto* nested = dynamic_cast<Diagram*>(system.get())) {
    nested->own_plan_.reset();
    nested->plan_ = nullptr;  // another plan may come to lie where that one was
  }
  const System& reference = *system;
  diagram_->children_.push_back({std::move(name), std::move(system)});
  return reference;
}

void DiagramBuilder::ConnectPorts(const OutputHandle& from, const InputHandle& to) {
  diagram_->connections_.push_back({from, to});
}

void DiagramBuilder::ExportInput(std::string name, const InputHandle& input, int size) {
  CheckName(name, "input");
  if (input.system == nullptr) {
    throw WiringError({fmt::format("exported input '{}': its port belongs to no system", name)});
  }
  auto& exported = diagram_->exported_inputs_;
  const auto same = std::find_if(exported.begin(), exported.end(),
                                 [&](const auto& other) { return other.name == name; });
  if (same != exported.end()) {
    same->to.push_back(input);
    return;
  }
  diagram_->AddInput(input.system->inputs().at(input.index));
  diagram_->inputs_.back().name = name;
  exported.push_back({std::move(name), {input}, size});
}

void DiagramBuilder::ExportOutput(std::string name, const OutputHandle& output) {
  CheckName(name, "output");
  for (const auto& other : diagram_->exported_outputs_) {
    if (other.first == name) {
      throw WiringError({fmt::format("output name: '{}' is exported twice", name)});
    }
  }
  if (output.system == nullptr) {
    throw WiringError({fmt::format("exported output '{}': its port belongs to no system", name)});
  }
  const System::OutputInfo& inner = output.system->outputs().at(output.index);
  diagram_->AddOutput({name, inner.type, inner.spec, {}, -1});
  diagram_->exported_outputs_.emplace_back(std::move(name), output);
}

std::unique_ptr<Diagram> DiagramBuilder::Build() {
  diagram_->own_plan_ = PlanCompiler::Compile(*diagram_);
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
