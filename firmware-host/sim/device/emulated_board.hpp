// SPDX-License-Identifier: GPL-3.0-or-later
// What the cable of an emulated device needs of its board.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tacto::firmware_host {

class EmulatedBoard {
 public:
  EmulatedBoard() = default;
  EmulatedBoard(const EmulatedBoard&) = delete;
  EmulatedBoard& operator=(const EmulatedBoard&) = delete;
  virtual ~EmulatedBoard() = default;

  virtual bool ticking() const = 0;
  /// By the host's clock; the device's clock may have an error. Precondition: ticking().
  virtual double host_period_s() const = 0;
  /// Computes one period of physics, then the firmware's tick. Precondition: ticking().
  virtual void step() = 0;
  virtual void poll() = 0;
  /// The data rate of the stream while ticking, in bytes per second.
  virtual double stream_bytes_per_s() const = 0;

  std::vector<std::uint8_t>& from_host() { return from_host_; }
  std::vector<std::uint8_t>& to_host() { return to_host_; }
  /// The number of bytes to the host that the link can hold; further bytes stay in the firmware's ring while
  /// it has room.
  void set_link_bytes(std::size_t bytes) { link_bytes_ = bytes; }

 protected:
  std::vector<std::uint8_t> from_host_, to_host_;
  std::size_t link_bytes_ = static_cast<std::size_t>(-1);
};

}  // namespace tacto::firmware_host
