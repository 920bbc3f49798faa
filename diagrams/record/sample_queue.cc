// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/sample_queue.h"

#include <algorithm>
#include <cstring>

#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/systems/signals/signals.h"

namespace oca::record {
namespace {

constexpr int kTexts = 256;

/// Lists grow to the capacity that the live one has, so that assigning does not allocate.
template <class T>
void Reserve(std::vector<T>& list, const std::vector<T>& live) {
  list.reserve(std::max<std::size_t>(live.capacity(), 8));
}

void Reserve(const SignalType& type, void* slot, const void* live) {
  using namespace systems;  // NOLINT: a table of signal types
  const auto is = [&type](const char* name) { return std::strcmp(type.name, name) == 0; };
  const auto both = [&]<class T>(auto T::*list) {
    Reserve(static_cast<T*>(slot)->*list, static_cast<const T*>(live)->*list);
  };
  if (is(Signal<ProximitySet>::kName)) both(&ProximitySet::proximities);
  if (is(Signal<LinkForceSet>::kName)) both(&LinkForceSet::forces);
  if (is(Signal<WrenchSet>::kName)) both(&WrenchSet::wrenches);
  if (is(Signal<ObstacleSet>::kName)) both(&ObstacleSet::obstacles);
  if (is(Signal<LinkPoses>::kName)) {
    both(&LinkPoses::links);
    both(&LinkPoses::poses);
    both(&LinkPoses::bodies);
    both(&LinkPoses::velocities);
  }
}

/// The value if it can be computed before the run has begun, else one made by default.
const void* LiveValue(const OutputHandle& output, const Context& context) {
  try {
    return EvalObject(output, context);
  } catch (const std::exception&) {
    return nullptr;  // the run itself will say what is wrong
  }
}

}  // namespace

SampleQueue::SampleQueue(const std::vector<Group>& groups, const Diagram& diagram,
                         const Context& context) {
  std::size_t room = kTexts;
  for (const Group& group : groups) {
    auto lane = std::make_unique<Lane>();
    lane->slots.capacity = static_cast<std::uint64_t>(group.capacity);
    for (const OutputHandle& output : group.outputs) {
      lane->columns.push_back(MakeColumn(output, group.capacity, diagram, context));
    }
    lane->values.resize(lane->columns.size());
    lanes_.push_back(std::move(lane));
    room += static_cast<std::size_t>(group.capacity);
  }
  texts_.capacity = kTexts;
  text_slots_.resize(kTexts);
  events_.resize(room);
}

SampleQueue::Column SampleQueue::MakeColumn(const OutputHandle& output, int capacity,
                                            const Diagram& diagram, const Context& context) {
  Column column{output, &TypeOfPort(output), 0, 0, nullptr, nullptr};
  const auto count = static_cast<std::size_t>(capacity);
  if (column.type == &kVectorType) {
    column.length = static_cast<std::size_t>(diagram.SizeOf(output));
    column.stride = column.length * sizeof(double);
    column.memory = std::make_unique<std::byte[]>(count * column.stride);
    column.first = column.memory.get();
    return column;
  }
  column.stride =
      (column.type->size + column.type->align - 1) / column.type->align * column.type->align;
  column.memory = std::make_unique<std::byte[]>(count * column.stride + column.type->align);
  void* first = column.memory.get();
  std::size_t space = count * column.stride + column.type->align;
  std::align(column.type->align, count * column.stride, first, space);
  column.first = static_cast<std::byte*>(first);
  const void* const live = LiveValue(output, context);
  for (std::size_t i = 0; i < count; ++i) {
    void* const slot = column.first + i * column.stride;
    column.type->construct(slot);
    if (live == nullptr) continue;
    Reserve(*column.type, slot, live);
    column.type->assign(slot, live);
  }
  return column;
}

SampleQueue::~SampleQueue() {
  for (const auto& lane : lanes_) {
    for (const Column& column : lane->columns) {
      if (column.type == &kVectorType) continue;
      for (std::size_t i = 0; i < lane->slots.capacity; ++i) {
        column.type->destroy(column.first + i * column.stride);
      }
    }
  }
}

bool SampleQueue::HasRoom(int group) const {
  return lanes_[static_cast<std::size_t>(group)]->slots.HasRoom();
}

int SampleQueue::VectorLength(int group, std::size_t output) const {
  return static_cast<int>(lanes_[static_cast<std::size_t>(group)]->columns[output].length);
}

bool SampleQueue::Drop() {
  dropped_.fetch_add(1, std::memory_order_relaxed);
  return false;
}

void SampleQueue::Announce(int group, double time) {
  const std::uint64_t at = announced_.load(std::memory_order_relaxed);
  events_[at % events_.size()] = {group, time};
  announced_.store(at + 1, std::memory_order_release);
}

bool SampleQueue::Store(int group, const Context& context) {
  Lane& lane = *lanes_[static_cast<std::size_t>(group)];
  if (!lane.slots.HasRoom()) return Drop();
  const std::uint64_t slot = lane.slots.stored % lane.slots.capacity;
  for (Column& column : lane.columns) {
    std::byte* const to = column.first + slot * column.stride;
    if (column.type == &kVectorType) {
      const auto values = EvalVector(column.output, context);
      std::memcpy(to, values.data(), column.stride);
    } else {
      column.type->assign(to, EvalObject(column.output, context));
    }
  }
  ++lane.slots.stored;
  Announce(group, context.time());
  return true;
}

bool SampleQueue::StoreText(int level, double time, std::string_view text) {
  if (!texts_.HasRoom()) return Drop();
  Text& slot = text_slots_[texts_.stored % texts_.capacity];
  slot.level = level;
  slot.size = std::min(text.size(), kTextSize);
  std::memcpy(slot.bytes, text.data(), slot.size);
  ++texts_.stored;
  Announce(-1, time);
  return true;
}

bool SampleQueue::Take(const std::function<void(const Sample&)>& use) {
  if (read_ == announced_.load(std::memory_order_acquire)) return false;
  const Event event = events_[read_ % events_.size()];
  ++read_;
  Slots& slots = event.group < 0 ? texts_ : lanes_[static_cast<std::size_t>(event.group)]->slots;
  const std::uint64_t taken = slots.taken.load(std::memory_order_relaxed);
  const std::uint64_t slot = taken % slots.capacity;
  if (event.group < 0) {
    const Text& text = text_slots_[slot];
    use({-1, event.time, {}, text.level, std::string_view(text.bytes, text.size)});
  } else {
    Lane& lane = *lanes_[static_cast<std::size_t>(event.group)];
    for (std::size_t i = 0; i < lane.columns.size(); ++i) {
      lane.values[i] = lane.columns[i].first + slot * lane.columns[i].stride;
    }
    use({event.group, event.time, lane.values, 0, {}});
  }
  slots.taken.store(taken + 1, std::memory_order_release);
  return true;
}

}  // namespace oca::record
