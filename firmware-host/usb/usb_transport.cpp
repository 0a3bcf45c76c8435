// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_transport.hpp"

#include <algorithm>
#include <chrono>

namespace tacto::firmware_host {

using schema::Result;

UsbTransport::UsbTransport(UsbConnection connection)
    : connection_(std::move(connection)), inflow_(connection_), outflow_(connection_) {}

double UsbTransport::now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Result<std::size_t> UsbTransport::read(std::span<std::uint8_t> bytes, double timeout_s) {
  const double deadline_s = now_s() + timeout_s;
  for (bool over = false;;) {
    const auto going = inflow_.keep_going();
    if (const std::size_t taken = inflow_.take(bytes); taken > 0) return taken;
    TACTO_TRY(going);
    if (over) return 0;
    const double left_s = std::max(0.0, deadline_s - now_s());
    over = left_s == 0;
    TACTO_TRY(inflow_.wait(left_s));
  }
}

// Received bytes are queued during writing, too.
Result<void> UsbTransport::write(std::span<const std::uint8_t> bytes, double timeout_s) {
  if (const auto going = inflow_.keep_going(); !going) return going;
  return outflow_.write(bytes, timeout_s);
}

}  // namespace tacto::firmware_host
