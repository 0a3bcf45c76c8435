// SPDX-License-Identifier: Apache-2.0
#include "firmware-host/core/wire/crc32c.hpp"

namespace tacto::wire {
namespace {

constexpr uint32_t kReflectedPolynomial = 0x82F63B78;

struct Table {
  uint32_t of[256];
};

constexpr uint32_t remainder_of(uint32_t byte) {
  for (int bit = 0; bit < 8; ++bit) byte = (byte >> 1) ^ ((byte & 1) != 0 ? kReflectedPolynomial : 0);
  return byte;
}

constexpr Table make_table() {
  Table table{};
  for (uint32_t byte = 0; byte < 256; ++byte) table.of[byte] = remainder_of(byte);
  return table;
}

constexpr Table kTable = make_table();

}  // namespace

uint32_t crc32c(const uint8_t* bytes, size_t size, uint32_t before) noexcept {
  uint32_t check = ~before;
  for (size_t i = 0; i < size; ++i) check = (check >> 8) ^ kTable.of[(check ^ bytes[i]) & 0xFFU];
  return ~check;
}

}  // namespace tacto::wire
