// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes from a device on USB: many transfers are pending at once, so that the device never waits.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "firmware-host/usb/usb_connection.hpp"

namespace tacto::firmware_host {

/// Transfers complete in libusb's event loop, which the caller runs; their bytes are queued here, in order.
/// After a stall, an overflow or a cable error all transfers are cancelled, the endpoint is cleared, and all
/// are submitted again; bytes that were lost in between are gaps for the reader of frames. For one thread.
class UsbInflow {
 public:
  /// 1 MiB in all: 0.3 s of the fastest stream (100 kHz x 8 channels, 3.2 MB/s) or 64 bursts of a slow one
  /// (0.2 s at 10 kHz) before the device has to wait. The kernel does not have to split a transfer of this
  /// size.
  static constexpr std::size_t kTransfers = 64, kTransferBytes = 16384;
  /// The number of consecutive errors, without a byte between them, that are tolerated.
  static constexpr int kMostTroubles = 5;

  /// The connection must outlive this object.
  explicit UsbInflow(const UsbConnection& connection);
  UsbInflow(const UsbInflow&) = delete;
  UsbInflow& operator=(const UsbInflow&) = delete;
  /// Cancels all transfers and waits for them.
  ~UsbInflow();

  /// Submits the idle transfers, and recovers from errors. Errors: device: gone, or not recoverable; from
  /// then on at each call.
  schema::Result<void> keep_going();
  bool empty() const { return full_.empty(); }
  /// Bytes of at most one transfer; returns their number.
  std::size_t take(std::span<std::uint8_t> bytes);
  /// Waits until a transfer has completed, or the time is over. Errors: device.
  schema::Result<void> wait(double timeout_s);

 private:
  struct Slot {
    UsbPointer<libusb_transfer> transfer;
    std::vector<std::uint8_t> buffer;
  };
  static void LIBUSB_CALL arrived(libusb_transfer* transfer);
  void sort_in(libusb_transfer* transfer);
  void note(libusb_transfer_status status);
  void recover();
  void give_up(libusb_transfer_status trouble);
  void submit_idle();
  void cancel_all();
  void end(const tl::unexpected<schema::Error>& reason);

  const UsbConnection& connection_;
  std::unique_ptr<std::vector<Slot>> slots_;
  std::vector<libusb_transfer*> idle_;
  std::deque<libusb_transfer*> full_;
  std::size_t used_ = 0;  // bytes of the first full one
  std::size_t under_way_ = 0;
  std::optional<libusb_transfer_status> trouble_;
  bool cancelled_ = false;
  int consecutive_errors_ = 0;
  std::optional<schema::Error> ended_;
  int woken_ = 0;
};

}  // namespace tacto::firmware_host
