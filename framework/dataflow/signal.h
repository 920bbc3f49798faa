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

/// What a Context knows of a type whose values it keeps.
struct ObjectType {
  std::size_t size;   ///< bytes; 0 for Vector, whose size the port says
  std::size_t align;  ///< bytes
  void (*construct)(void* at);
  void (*destroy)(void* at);
  void (*assign)(void* to, const void* from);
};

template <class T>
constexpr ObjectType ObjectTypeOf() {
  return {sizeof(T), alignof(T), [](void* at) { new (at) T; },
          [](void* at) { static_cast<T*>(at)->~T(); },
          [](void* to, const void* from) { *static_cast<T*>(to) = *static_cast<const T*>(from); }};
}

/// What the engine, the recorder and `eval` know of a signal type, without its C++ type.
struct SignalType : ObjectType {
  const char* name;
  Fault (*check)(const void* value, Look look);
  /// nullptr: only states are of this type.
  void (*write_json)(const void* value, std::string& out);
  /// Reads and checks; throws ConfigError saying what is wrong. nullptr: no input is of this type.
  void (*read_json)(std::string_view text, void* value);
};

/// Trait of a type that ports and states carry. A signal type specialises it with
/// `static constexpr const char* kName` and `static Fault Check(const T&, Look)`; one that outputs
/// show also with `static void WriteJson(const T&, std::string&)`, and one that inputs take with
/// `static T ReadJson(std::string_view)`; all but the name are defined in a source file. Check
/// alone judges what a value may be: whoever takes one from outside asks with Look::kWhole, the
/// engine asks of all that it computes with Look::kFinite, which costs no more than a look at the
/// numbers. `static void FromOutside(T&)`, if there is one, drops what only systems may say to each
/// other. Values are copied by assignment, so a type whose assignment does not allocate once its
/// capacity suffices keeps the run free of the heap.
template <class T>
struct Signal;

/// Whether outputs can be of the type.
template <class T>
concept Shown = std::is_same_v<T, Vector> || requires(const T& value, std::string& out) {
  Signal<T>::WriteJson(value, out);
};
/// Whether inputs can be of the type.
template <class T>
concept Taken = std::is_same_v<T, Vector> || requires(T& value, std::string_view text) {
  value = Signal<T>::ReadJson(text);
};

/// Vectors live in the arena itself; only the name of this entry is ever used.
extern const SignalType kVectorType;

namespace internal {

template <class T>
constexpr auto WriterOf() -> decltype(SignalType::write_json) {
  if constexpr (Shown<T>) {
    return [](const void* value, std::string& out) {
      Signal<T>::WriteJson(*static_cast<const T*>(value), out);
    };
  } else {
    return nullptr;
  }
}

template <class T>
constexpr auto ReaderOf() -> decltype(SignalType::read_json) {
  if constexpr (Taken<T>) {
    return [](std::string_view text, void* value) {
      T read = Signal<T>::ReadJson(text);
      ThrowIf(Signal<T>::Check(read, Look::kWhole));
      *static_cast<T*>(value) = std::move(read);
    };
  } else {
    return nullptr;
  }
}

}  // namespace internal

template <class T>
const SignalType& TypeOf() {
  if constexpr (std::is_same_v<T, Vector>) {
    return kVectorType;
  } else {
    static constexpr SignalType kType{ObjectTypeOf<T>(), Signal<T>::kName,
                                      [](const void* value, Look look) {
                                        return Signal<T>::Check(*static_cast<const T*>(value),
                                                                look);
                                      },
                                      internal::WriterOf<T>(), internal::ReaderOf<T>()};
    return kType;
  }
}

/// The JSON of a value made by default, which tells the members of a type that is no Vector and
/// that outputs show. throws ConfigError if the type's WriteJson writes none.
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
