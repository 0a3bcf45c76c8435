// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the bytes that a device sends with those that a serial line carries.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "data-schema/base/error.hpp"

namespace tacto::firmware_host {

/// Bytes of one frame of samples, in messages of `block_frames`.
double bytes_per_frame(std::size_t channels, std::size_t block_frames);
/// Bytes of one tick, in messages as the core sends them (every 10 ms, or every 64 ticks if that is earlier).
/// `axes`: of a device with forces that plays a scene; 0: of a drive.
double bytes_per_tick(double rate_hz, std::size_t axes);

/// A serial line, and the bytes that are already sent over it.
struct SerialLine {
  double baud = 0;
  double used_bytes_per_s = 0;
};

/// Refuses a rate of frames or ticks that the line does not carry. `bytes_of_one` gives the bytes of one
/// frame or tick at a rate. Errors: unsuitable, with the largest whole rate that fits and the baud rate that
/// would be needed.
schema::Result<void> check_line(const SerialLine& line, double rate_hz,
                                const std::function<double(double rate_hz)>& bytes_of_one,
                                const std::string& where);

}  // namespace tacto::firmware_host
