// SPDX-License-Identifier: Apache-2.0
// The functions that compilers call implicitly, for a program without any library.
#include <stddef.h>

extern "C" {
// no_builtin: otherwise the compiler would replace the loops by calls of these functions.
[[clang::no_builtin]] void* memcpy(void* to, const void* from, size_t size) {
  for (size_t i = 0; i < size; ++i) static_cast<char*>(to)[i] = static_cast<const char*>(from)[i];
  return to;
}
[[clang::no_builtin]] void* memset(void* to, int value, size_t size) {
  for (size_t i = 0; i < size; ++i) static_cast<char*>(to)[i] = static_cast<char>(value);
  return to;
}
void __aeabi_memcpy(void* to, const void* from, size_t size) {
  memcpy(to, from, size);
}
void __aeabi_memcpy4(void* to, const void* from, size_t size) {
  memcpy(to, from, size);
}
void __aeabi_memcpy8(void* to, const void* from, size_t size) {
  memcpy(to, from, size);
}
[[clang::no_builtin]] void __aeabi_memmove(void* to, const void* from, size_t size) {
  if (to < from) memcpy(to, from, size);
  if (to > from)
    while (size-- > 0) static_cast<char*>(to)[size] = static_cast<const char*>(from)[size];
}
void __aeabi_memclr(void* to, size_t size) {
  memset(to, 0, size);
}
void __aeabi_memclr4(void* to, size_t size) {
  memset(to, 0, size);
}
void __aeabi_memclr8(void* to, size_t size) {
  memset(to, 0, size);
}
}
