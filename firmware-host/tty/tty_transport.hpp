// SPDX-License-Identifier: GPL-3.0-or-later
// A serial port as the cable to a device.
#pragma once

#include <memory>
#include <string>

#include "firmware-host/link/file_descriptor.hpp"
#include "firmware-host/link/transport.hpp"
#include "firmware-host/tty/raw_settings.hpp"
#include "firmware-host/tty/tty_address.hpp"

namespace tacto::firmware_host {

/// Raw and for this program alone while it is open; then the port has its former settings again. All work is
/// done in the caller's thread. Between calls the kernel keeps some kilobytes that arrive (DECISIONS.md).
class TtyTransport final : public Transport {
 public:
  /// Precondition: a path. Errors: not_found: no such port, or this user may not open it, with the group that
  /// may; usage: no serial port; device: another program uses it, or it does not support the baud rate.
  static schema::Result<std::unique_ptr<TtyTransport>> open(const TtyAddress& address);
  TtyTransport(const TtyTransport&) = delete;
  TtyTransport& operator=(const TtyTransport&) = delete;
  ~TtyTransport() override;

  schema::Result<std::size_t> read(std::span<std::uint8_t> bytes, double timeout_s) override;
  schema::Result<void> write(std::span<const std::uint8_t> bytes, double timeout_s) override;
  /// Of the steady clock.
  double now_s() override;
  /// Infinite for a port of the kernel's driver for boards with a USB port of their own (ttyACM), if no rate
  /// is named: there the rate is only a number.
  double baud() const override { return baud_; }
  double start_up_s() const override;

 private:
  TtyTransport(FileDescriptor port, std::string where, const termios& before)
      : port_(std::move(port)), where_(std::move(where)), before_(before) {}
  schema::Result<void> configure(unsigned baud);
  bool wait(short events, double until_s);
  tl::unexpected<schema::Error> failed(int code) const;

  FileDescriptor port_;
  std::string where_;
  termios before_;
  double baud_ = 0;
};

}  // namespace tacto::firmware_host
