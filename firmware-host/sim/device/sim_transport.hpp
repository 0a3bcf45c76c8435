// SPDX-License-Identifier: GPL-3.0-or-later
// The cable to the emulated device: bytes through memory, and emulated time that passes while the host waits.
#pragma once

#include <optional>

#include "firmware-host/link/pacer.hpp"
#include "firmware-host/link/transport.hpp"
#include "firmware-host/sim/device/emulated_board.hpp"

namespace tacto::firmware_host {

/// Emulated time passes in read(), until there is something to read: at full speed, or paced by the clock.
/// now_s() is emulated time, so timeouts are exact and cause no delay. If paced with a link of limited time,
/// the device does not wait for a late reader: it runs all ticks that are due, and loses what neither link
/// nor ring can hold. The board must outlive this object.
class SimTransport final : public Transport {
 public:
  SimTransport(EmulatedBoard& board, bool paced, std::optional<double> link_buffer_s = std::nullopt);

  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override;
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s) override;
  double now_s() override { return now_s_; }

 private:
  void pass_time(double until_s);
  void pass_real_time(double until_s);
  void tick();

  EmulatedBoard& board_;
  std::optional<Pacer> pacer_;
  std::optional<double> link_buffer_s_;
  double now_s_ = 0;
};

}  // namespace tacto::firmware_host
