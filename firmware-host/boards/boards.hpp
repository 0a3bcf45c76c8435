// SPDX-License-Identifier: Apache-2.0
// The boards that have firmware, and the instructions of a tick on their cores: the table that the firmware,
// its build (make.sh) and `explain --board` read.
#pragma once

#include <stdint.h>

namespace tacto::boards {

enum class Core : uint8_t { cortex_m4, cortex_m33 };

struct Board {
  const char* name;
  Core core;
  uint32_t clock_hz;
  uint32_t ram_bytes;
  uint32_t samples;  ///< of a texture, 4 bytes each; a scene uses the same memory
  uint32_t least_rate_hz, usual_rate_hz, most_rate_hz;
  uint32_t uf2_family;  ///< 0: its boot loader takes no UF2
};

// One row a line: make.sh reads name, core and family. The family is that of microsoft/uf2, uf2families.json.
inline constexpr Board kBoards[] = {
    {"stm32f405", Core::cortex_m4, 168'000'000, 131'072, 12'000, 500, 2'000, 5'000, 0},
    {"rp2350", Core::cortex_m33, 150'000'000, 532'480, 70'000, 500, 2'000, 5'000, 0xe48bff59},
};

constexpr bool same(const char* a, const char* b) {
  while (*a != 0 && *a == *b) ++a, ++b;
  return *a == *b;
}

/// Null if there is none of that name.
constexpr const Board* board_named(const char* name) {
  for (const Board& board : kBoards)
    if (same(board.name, name)) return &board;
  return nullptr;
}

/// QEMU counts instructions. On these cores most take one cycle, loads two, taken branches three, a division
/// of floats fourteen: three for each are more than the tick's mix needs.
inline constexpr uint32_t kCyclesPerInstruction = 3;

inline constexpr uint32_t kPlaneKinds = 11;  ///< of layers of force patches: core::SceneLayerKind, 0 to 10

/// Instructions at most. A part of a tick is the difference of two ticks, with and without it.
struct TickCosts {
  uint32_t around;   ///< of a tick, what is not the kernel: inputs, supervision, the record of it
  uint32_t poll;     ///< of the main loop for each tick: sending samples and ticks
  uint32_t read[4];  ///< the kernel by interpolation (wire::Interpolation), while a texture changes
  uint32_t sixteen_taps;
  uint32_t section;
  uint32_t four_plays;  ///< play operators of the hysteresis
  uint32_t scene;       ///< the kernel of a scene that has no layer at the hand's place
  uint32_t patch;       ///< a patch there
  uint32_t layer[kPlaneKinds];
  uint32_t harmonic, octave, atom;  ///< more of grooves, noise and a field for each
};

/// By Core. The tests cortex_m4 and cortex_m33 measure each number again (tests/firmware-host).
inline constexpr TickCosts kTickCosts[] = {
    {.around = 331,
     .poll = 1154,
     .read = {2273, 2232, 2411, 2394},
     .sixteen_taps = 83,
     .section = 29,
     .four_plays = 80,
     .scene = 5466,
     .patch = 211,
     .layer = {60, 54, 286, 310, 1166, 295, 292, 66, 131, 1245, 66},
     .harmonic = 22,
     .octave = 314,
     .atom = 42},
    {.around = 315,
     .poll = 1145,
     .read = {2237, 2207, 2385, 2365},
     .sixteen_taps = 82,
     .section = 29,
     .four_plays = 71,
     .scene = 5443,
     .patch = 211,
     .layer = {58, 54, 279, 306, 1161, 293, 293, 63, 127, 1229, 65},
     .harmonic = 22,
     .octave = 314,
     .atom = 41},
};

}  // namespace tacto::boards
