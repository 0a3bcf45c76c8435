// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/firmware-host/allocation_hook.hpp"

#include <cstdlib>
#include <new>

namespace {
thread_local long counted = 0;
}

void* operator new(std::size_t size) {
  ++counted;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++counted;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace tacto::tests {

long allocations_here() {
  return counted;
}

}  // namespace tacto::tests
