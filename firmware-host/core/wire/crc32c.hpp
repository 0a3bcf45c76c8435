// SPDX-License-Identifier: Apache-2.0
// The checksum of every frame and profile: CRC-32C.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace tacto::wire {

/// CRC-32C (Castagnoli): polynomial 0x1EDC6F41, bits reflected (0x82F63B78), initial value and final XOR
/// 0xFFFFFFFF; for "123456789" it is 0xE3069283 (RFC 3720, appendix B.4). `before` is the check of the
/// preceding bytes, so that parts may be checked one after the other. Safe in the tick.
uint32_t crc32c(const uint8_t* bytes, size_t size, uint32_t before = 0) noexcept;

}  // namespace tacto::wire
