// SPDX-License-Identifier: GPL-3.0-or-later
// The cable to a device on USB.
#pragma once

#include "firmware-host/link/transport.hpp"
#include "firmware-host/usb/usb_inflow.hpp"
#include "firmware-host/usb/usb_outflow.hpp"

namespace tacto::firmware_host {

/// All work is done in the caller's thread, within read() and write(); between calls the kernel continues to
/// fill transfers (see UsbInflow for how long). Bytes received before an error are returned before the error.
class UsbTransport final : public Transport {
 public:
  explicit UsbTransport(UsbConnection connection);

  /// Errors, besides those of Transport: device: the endpoint fails and does not recover.
  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override;
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s) override;
  /// Of the steady clock.
  double now_s() override;

  /// The URI that distinguishes the device from others.
  const std::string& uri() const { return connection_.uri(); }

 private:
  UsbConnection connection_;
  UsbInflow inflow_;
  UsbOutflow outflow_;
};

}  // namespace tacto::firmware_host
