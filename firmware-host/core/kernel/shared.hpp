// SPDX-License-Identifier: Apache-2.0
// One word shared by the tick, which may interrupt the main loop anywhere, and the main loop.
#pragma once

#include <stdint.h>

namespace tacto::core {

/// Loads acquire and stores release: data written before a store are visible after the load of its value. At
/// most 32 bits: one instruction on a Cortex-M, never a lock. Safe in the tick.
template <class T>
class Shared {
  static_assert(sizeof(T) <= 4);

 public:
  explicit Shared(T value = T{}) noexcept : value_(value) {}
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;

  T load() const noexcept {
    T value;
    __atomic_load(&value_, &value, __ATOMIC_ACQUIRE);
    return value;
  }
  void store(T value) noexcept { __atomic_store(&value_, &value, __ATOMIC_RELEASE); }

 private:
  T value_;
};

}  // namespace tacto::core
