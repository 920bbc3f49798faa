// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "oca/framework/dataflow/fault.h"

namespace oca {

/// The signal type of a column of doubles; its length is settled at Build.
struct Vector {};

using VectorView = Eigen::Map<const Eigen::VectorXd>;
using MutableVectorView = Eigen::Map<Eigen::VectorXd>;

namespace internal {
/// throws ConfigError with what is wrong, if anything is.
void ThrowIf(const Fault& fault);
}  // namespace internal

/// What the engine, the recorder and `eval` know of a signal type, without its C++ type.
struct SignalType {
  const char* name;
  std::size_t size;   ///< bytes; 0 for Vector, whose size the port says
  std::size_t align;  ///< bytes
  void (*construct)(void* at);
  void (*destroy)(void* at);
  void (*assign)(void* to, const void* from);
  Fault (*check)(const void* value, Look look);
  void (*write_json)(const void* value, std::string& out);
  /// Reads and checks; throws ConfigError saying what is wrong.
  void (*read_json)(std::string_view text, void* value);
};

/// Trait of a type that ports carry. A signal type specialises it with
/// `static constexpr const char* kName`, `static Fault Check(const T&, Look)`,
/// `static void WriteJson(const T&, std::string&)` and `static T ReadJson(std::string_view)`,
/// the last three defined in a source file. Check alone judges what a value may be: whoever takes
/// one from outside asks with Look::kWhole, the engine asks of all that it computes with
/// Look::kFinite, which costs no more than a look at the numbers. `static void FromOutside(T&)`, if
/// there is one, drops what only systems may say to each other. Values are copied by assignment, so
/// a type whose assignment does not allocate once its capacity suffices keeps the run free of the
/// heap.
template <class T>
struct Signal;

/// Vectors live in the arena itself; only the name of this entry is ever used.
extern const SignalType kVectorType;

template <class T>
const SignalType& TypeOf() {
  if constexpr (std::is_same_v<T, Vector>) {
    return kVectorType;
  } else {
    static constexpr SignalType kType{
        Signal<T>::kName,
        sizeof(T),
        alignof(T),
        [](void* at) { new (at) T; },
        [](void* at) { static_cast<T*>(at)->~T(); },
        [](void* to, const void* from) { *static_cast<T*>(to) = *static_cast<const T*>(from); },
        [](const void* value, Look look) {
          return Signal<T>::Check(*static_cast<const T*>(value), look);
        },
        [](const void* value, std::string& out) {
          Signal<T>::WriteJson(*static_cast<const T*>(value), out);
        },
        [](std::string_view text, void* value) {
          T read = Signal<T>::ReadJson(text);
          internal::ThrowIf(Signal<T>::Check(read, Look::kWhole));
          *static_cast<T*>(value) = std::move(read);
        }};
    return kType;
  }
}

/// The JSON of a value made by default, which tells the members of a type that is no Vector.
/// throws ConfigError if the type's WriteJson writes none.
std::string DefaultJson(const SignalType& type);

/// Where a value lies in a Context.
struct Slot {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::uint32_t offset{kNone};  ///< bytes from the start of the arena
  std::uint32_t size{0};        ///< length of a vector
};

/// How calculations see a signal: read-only, writable, or perhaps absent.
template <class T>
struct ViewOf {
  using Const = const T&;
  using Mutable = T&;
  using Optional = const T*;
  static Const Read(const std::byte* arena, Slot slot) {
    return *std::launder(reinterpret_cast<const T*>(arena + slot.offset));
  }
  static Mutable Write(std::byte* arena, Slot slot) {
    return *std::launder(reinterpret_cast<T*>(arena + slot.offset));
  }
  static Optional ReadOptional(const std::byte* arena, Slot slot) {
    return slot.offset == Slot::kNone ? nullptr : &Read(arena, slot);
  }
};

template <>
struct ViewOf<Vector> {
  using Const = VectorView;
  using Mutable = MutableVectorView;
  using Optional = std::optional<VectorView>;
  static Const Read(const std::byte* arena, Slot slot) {
    return {reinterpret_cast<const double*>(arena + slot.offset), slot.size};
  }
  static Mutable Write(std::byte* arena, Slot slot) {
    return {reinterpret_cast<double*>(arena + slot.offset), slot.size};
  }
  static Optional ReadOptional(const std::byte* arena, Slot slot) {
    if (slot.offset == Slot::kNone) return std::nullopt;
    return Read(arena, slot);
  }
};

/// True if none of the `n` doubles is a NaN or an infinity.
inline bool AllFinite(const double* values, std::size_t n) {
  // Adding one to an exponent field of all ones carries into the sign bit: no branch a value. Two
  // values a time, in a register that every x86-64 and ARM64 processor has.
  using Pair = std::uint64_t __attribute__((vector_size(16)));
  constexpr std::uint64_t kExponent = 0x7ff0000000000000;
  constexpr std::uint64_t kOne = 0x0010000000000000;
  Pair carry{};
  std::size_t i = 0;
  for (; i + 2 <= n; i += 2) {
    Pair bits;
    std::memcpy(&bits, values + i, sizeof bits);
    carry |= (bits & kExponent) + kOne;
  }
  std::uint64_t last = 0;
  if (i < n) last = (std::bit_cast<std::uint64_t>(values[i]) & kExponent) + kOne;
  return ((carry[0] | carry[1] | last) >> 63) == 0;
}

/// A vector as a JSON array of shortest round-trip numbers; null stands for NaN and infinity.
void WriteVectorJson(const double* values, std::size_t n, std::string& out);
/// throws ConfigError unless `text` is a JSON array of finite numbers.
Eigen::VectorXd ReadVectorJson(std::string_view text);

}  // namespace oca
