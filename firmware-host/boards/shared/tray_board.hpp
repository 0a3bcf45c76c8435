// SPDX-License-Identifier: Apache-2.0
// What the boards have in common that drive the rig of RIG.md: what they say of themselves, their converters
// of 12 bits, the check of their flash, and the bytes between the link and the firmware.
#pragma once

#include "firmware-host/boards/boards.hpp"
#include "firmware-host/boards/shared/cortex_m.hpp"
#include "firmware-host/core/firmware/board.hpp"
#include "firmware-host/core/firmware/hal.hpp"
#include "firmware-host/core/kernel/ring.hpp"
#include "firmware-host/core/wire/crc32c.hpp"

inline void* operator new(size_t, void* place) noexcept {
  return place;
}

extern "C" {
extern const uint8_t image_begin, image_check, image_end;  // memory.ld, in the flash
}

namespace tacto::boards {

// The numbers of your rig: change them, make the firmware again, and flash it.
constexpr double kEncoderStepM = 1e-6;  ///< of a count
constexpr double kForceFullN = 10;      ///< of the load cell for 1.65 V at the pin; `calibrate` measures it
constexpr double kTrayMPerV = 10e-6;    ///< of the displacement sensor
constexpr char kTransducer[] = "wiertlewski2011";

/// Volts before the divider of signals.svg for 1.65 V behind it, which has 0.1596 of them.
constexpr double kDividedFullV = 1.65 / 0.1596;
constexpr float kDriveFullV = 5;
constexpr uint32_t kDriveZero = 2048;  ///< of a converter of 12 bits

/// For volts at the amplifier's input, rounded.
inline uint32_t drive_code(float volts) {
  const float code = static_cast<float>(kDriveZero) + 0.5F + volts * (2047 / kDriveFullV);
  return static_cast<uint32_t>(code < 0 ? 0 : code > 4095 ? 4095 : code);
}

inline float volts_of(uint32_t drive_code) {
  return (static_cast<float>(drive_code) - static_cast<float>(kDriveZero)) * (kDriveFullV / 2047);
}

/// 12 bits, left-justified around their middle.
inline int32_t left_justified(uint32_t code) {
  return static_cast<int32_t>((code - 2048) << 20);
}

/// Between the link and the firmware, which may be on two cores.
using Bytes = core::Ring<uint8_t, 4096>;
inline bool put(Bytes& ring, uint8_t byte) {
  uint8_t* const place = ring.place();
  if (place == nullptr) return false;
  *place = byte;
  ring.push();
  return true;
}
inline bool take(Bytes& ring, uint8_t& byte) {
  const uint8_t* const front = ring.front();
  if (front == nullptr) return false;
  byte = *front;
  ring.pop();
  return true;
}
/// As core::Hal has them.
inline size_t take(Bytes& ring, uint8_t* bytes, size_t capacity) {
  size_t size = 0;
  while (size < capacity && take(ring, bytes[size])) ++size;
  return size;
}
inline size_t put(Bytes& ring, const uint8_t* bytes, size_t size) {
  size_t accepted = 0;
  while (accepted < size && put(ring, bytes[accepted])) ++accepted;
  return accepted;
}

/// The part of the hardware layer that needs only the timer and the bytes.
template <auto& kTimer, Bytes& kReceived, Bytes& kToSend>
core::Hal timed_hal() {
  core::Hal hal;
  hal.clock = [](void*) noexcept { return kTimer.clock(); };
  hal.set_rate = [](void*, uint32_t rate) noexcept { kTimer.set_rate(rate); };
  hal.receive = [](void*, uint8_t* bytes, size_t capacity) noexcept {
    return take(kReceived, bytes, capacity);
  };
  hal.send = [](void*, const uint8_t* bytes, size_t size) noexcept { return put(kToSend, bytes, size); };
  return hal;
}

inline uint32_t stored_check() {
  return at(static_cast<uint32_t>(reinterpret_cast<uintptr_t>(&image_check)));
}

/// The check covers all of the image but its own word, which firmware-host/boards/image.py writes.
inline bool flash_is_intact(uint32_t stored) {
  const uint32_t before = wire::crc32c(&image_begin, static_cast<size_t>(&image_check - &image_begin));
  const uint8_t* const after = &image_check + sizeof(uint32_t);
  return wire::crc32c(after, static_cast<size_t>(&image_end - after), before) == stored;
}

template <size_t kSize>
void put(char (&field)[kSize], const char* text) {
  for (size_t i = 0; i + 1 < kSize && text[i] != 0; ++i) field[i] = text[i];
}

/// Eight digits for each word.
inline void put_hex(char* digits, const uint32_t* words, uint32_t count) {
  for (uint32_t i = 0; i < 8 * count; ++i)
    digits[i] = "0123456789abcdef"[words[i / 8] >> (28 - 4 * (i % 8)) & 15];
}

struct Tray {
  wire::Channel channels[4];
  wire::Note notes[2];
};

inline wire::Channel channel(uint8_t index, const char* name, const char* unit, double scale,
                             const char* source) {
  wire::Channel about{};
  about.index = index;
  put(about.name, name);
  put(about.quantity, name);
  put(about.unit, unit);
  put(about.source, source);
  about.scale = scale;
  about.range_min = about.range_max = about.native_rate_hz = __builtin_nan("");
  return about;
}

inline wire::Note note(uint8_t index, wire::NoteKind kind, const char* text) {
  wire::Note about{};
  about.index = index;
  about.kind = kind;
  put(about.text, text);
  return about;
}

/// A code of 2^31 is 1.65 V at the pin. `sources` are the inputs of the three channels behind the encoder's;
/// without a sensor at the tray the last one is missing. `check` is that of the flash: image.py prints the
/// same digits, which follow `version` ("0.1.0 build "). The caller sets the serial number.
template <size_t kVersionSize>
core::Board describe(const Board& row, Tray& tray, float* profile_memory, const char* const (&sources)[3],
                     bool has_tray_sensor, uint32_t check, const char (&version)[kVersionSize]) {
  constexpr double kFullCode = 2147483648.0;
  tray.channels[0] = channel(0, "position", "m", kEncoderStepM, "encoder");
  tray.channels[1] = channel(1, "tangential_force", "V", kDividedFullV / kFullCode, sources[0]);
  tray.channels[2] = channel(2, "normal_force", "N", kForceFullN / kFullCode, sources[1]);
  tray.channels[3] = channel(3, "displacement", "m", kTrayMPerV * kDividedFullV / kFullCode, sources[2]);
  tray.notes[0] = note(0, wire::NoteKind::transducer, kTransducer);
  core::Board board;
  put(board.about.name, row.name);
  put(board.about.firmware, version);
  static_assert(kVersionSize + 8 <= sizeof board.about.firmware);
  put_hex(board.about.firmware + kVersionSize - 1, &check, 1);
  board.about.features = wire::kFeatureDrive | wire::kFeatureEnableInput;
  board.about.clock_hz = row.clock_hz;
  board.about.default_rate_millihertz = row.usual_rate_hz * 1000;
  board.about.least_rate_millihertz = row.least_rate_hz * 1000;
  board.about.most_rate_millihertz = row.most_rate_hz * 1000;
  board.about.drive_limit_v = kDriveFullV;
  board.about.slew_limit_v_per_s = 15'000;
  board.channels = tray.channels;
  board.channel_count = has_tray_sensor ? 4 : 3;
  board.profile_memory = profile_memory;
  board.profile_samples = row.samples;
  board.notes = tray.notes;
  board.note_count = 1;
  return board;
}

}  // namespace tacto::boards
