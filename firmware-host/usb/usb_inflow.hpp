// SPDX-License-Identifier: GPL-3.0-or-later
// Bytes from a device on USB: many transfers under way at once, so that the device is always listened to.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "firmware-host/usb/usb_connection.hpp"

namespace tacto::firmware_host {

/// Transfers complete in libusb's event loop, which the caller runs; what they brought waits here, in order.
/// After a stall, an overflow or an error on the cable all of them are taken back, the endpoint is cleared,
/// and all begin again: bytes that were lost meanwhile are gaps for whoever reads frames. One thread.
class UsbInflow {
 public:
  /// 1 MiB in all: 0.3 s of the fastest stream (100 kHz x 8 channels, 3.2 MB/s) or 64 bursts of a slow one
  /// (0.2 s at 10 kHz) before the device has to wait. A transfer is one that the kernel need not split.
  static constexpr std::size_t kTransfers = 64, kTransferBytes = 16384;
  /// Troubles in a row, without a byte between them, before it gives up.
  static constexpr int kMostTroubles = 5;

  /// The connection outlives it.
  explicit UsbInflow(const UsbConnection& connection);
  UsbInflow(const UsbInflow&) = delete;
  UsbInflow& operator=(const UsbInflow&) = delete;
  /// Takes back all transfers and waits for them.
  ~UsbInflow();

  /// Puts under way what is idle, and recovers from trouble. Errors: device: gone, or troubled beyond
  /// recovery; from then on, always.
  schema::Result<void> keep_going();
  bool empty() const { return full_.empty(); }
  /// Bytes of one transfer at most; gives their number.
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
  int troubles_in_a_row_ = 0;
  std::optional<schema::Error> ended_;
  int woken_ = 0;
};

}  // namespace tacto::firmware_host
