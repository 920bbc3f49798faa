// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "oca/framework/dataflow/context.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/port.h"
#include "oca/framework/dataflow/signal.h"

namespace oca::record {

/// Carries samples of outputs from the thread of a run to another one, in order and without a lock.
/// All memory is taken before the run: a sample is a copy of values into slots that exist, so that
/// no tick allocates or waits. What finds no slot is not stored, and counted.
///
/// One thread stores, one takes.
class SampleQueue {
 public:
  /// Outputs that are sampled together.
  struct Group {
    std::vector<OutputHandle> outputs;
    int capacity;  ///< samples
  };

  /// A sample as it comes out. `values` one an output of the group: `const double*` of a Vector,
  /// else its C++ type. A text has group -1.
  struct Sample {
    int group;
    double time;  ///< s
    std::span<const void* const> values;
    int level;
    std::string_view text;
  };

  /// The outputs are those of `diagram`; `context` settles the capacity of lists.
  SampleQueue(const std::vector<Group>& groups, const Diagram& diagram, const Context& context);
  ~SampleQueue();
  SampleQueue(const SampleQueue&) = delete;
  SampleQueue& operator=(const SampleQueue&) = delete;

  /// Evaluates and copies a group's outputs. Returns false, having counted a drop, if it is full.
  /// throws SimulationError as evaluating does; nothing is stored then.
  bool Store(int group, const Context& context);
  /// Stores a text, cut to kTextSize bytes.
  bool StoreText(int level, double time, std::string_view text);
  /// Whether Store would find room.
  bool HasRoom(int group) const;
  bool HasRoomForText() const { return texts_.HasRoom(); }

  /// Calls `use` with the oldest sample and frees its slot. Returns false if there is none.
  bool Take(const std::function<void(const Sample&)>& use);

  std::int64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }
  int VectorLength(int group, std::size_t output) const;
  static constexpr std::size_t kTextSize = 1000;

 private:
  /// Slots of one kind, used in turn.
  struct Slots {
    std::uint64_t capacity{0};
    std::uint64_t stored{0};  ///< of the storing thread
    std::atomic<std::uint64_t> taken{0};
    bool HasRoom() const { return stored - taken.load(std::memory_order_acquire) < capacity; }
  };
  struct Column {
    OutputHandle output;
    const SignalType* type;
    std::size_t length;  ///< of a Vector
    std::size_t stride;  ///< bytes
    std::unique_ptr<std::byte[]> memory;
    std::byte* first;
  };
  struct Lane {
    Slots slots;
    std::vector<Column> columns;
    std::vector<const void*> values;  ///< of the taking thread
  };
  struct Text {
    int level;
    std::size_t size;
    char bytes[kTextSize];
  };
  struct Event {
    int group;
    double time;
  };

  static Column MakeColumn(const OutputHandle& output, int capacity, const Diagram& diagram,
                           const Context& context);
  void Announce(int group, double time);
  bool Drop();

  std::vector<std::unique_ptr<Lane>> lanes_;
  Slots texts_;
  std::vector<Text> text_slots_;
  std::vector<Event> events_;  ///< a ring with room for all slots
  std::atomic<std::uint64_t> announced_{0};
  std::uint64_t read_{0};
  std::atomic<std::int64_t> dropped_{0};
};

}  // namespace oca::record
