// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_outflow.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "firmware-host/usb/usb_words.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

constexpr int kSendAttempts = 3;
constexpr double kStepS = 0.1;
constexpr auto kLongestFlush = std::chrono::seconds(2);

}  // namespace

UsbOutflow::UsbOutflow(const UsbConnection& connection)
    : connection_(connection), transfer_(libusb_alloc_transfer(0)) {}

UsbOutflow::~UsbOutflow() {
  if (!under_way_) return;
  libusb_cancel_transfer(transfer_.get());
  (void)await_end();
}

void UsbOutflow::gone(libusb_transfer* transfer) {
  auto& outflow = *static_cast<UsbOutflow*>(transfer->user_data);
  outflow.under_way_ = false;
  outflow.done_ = 1;
}

Result<void> UsbOutflow::write(std::span<const std::uint8_t> bytes, double timeout_s) {
  buffer_.assign(bytes.begin(), bytes.end());
  for (int attempt = 0; attempt < kSendAttempts; ++attempt) {
    if (const auto sent = send(timeout_s); !sent) return sent;
    if (sent_whole()) return {};
    if (transfer_->status == LIBUSB_TRANSFER_TIMED_OUT)
      return fail(ErrorKind::device, fmt::format("the device accepted no data for {:g} s", timeout_s),
                  connection_.uri(), "unplug it and plug it in again");
    if (const auto cleared = clear(); !cleared) return cleared;
  }
  return fail(ErrorKind::device, fmt::format("the device refused the sent data {} times", kSendAttempts),
              connection_.uri(), "unplug it and plug it in again");
}

Result<void> UsbOutflow::send(double timeout_s) {
  if (!transfer_ || under_way_) return usb_failure(LIBUSB_ERROR_NO_MEM, "writing", connection_.uri());
  libusb_fill_bulk_transfer(transfer_.get(), connection_.handle(), connection_.interface().out,
                            buffer_.data(), static_cast<int>(buffer_.size()), gone, this,
                            static_cast<unsigned>(std::ceil(timeout_s * 1e3)));
  transfer_->flags = LIBUSB_TRANSFER_ADD_ZERO_PACKET;
  const int code = libusb_submit_transfer(transfer_.get());
  if (code != 0) return usb_failure(code, "writing", connection_.uri());
  under_way_ = true;
  return await_end();
}

// libusb ends each transfer at its timeout; the longer wait is for a kernel that does not. If this program
// was delayed, it checks once more before it reports an error.
Result<void> UsbOutflow::await_end() {
  const auto begun = std::chrono::steady_clock::now();
  for (done_ = 0; under_way_;) {
    const bool late = std::chrono::steady_clock::now() - begun > kLongestFlush;
    if (const auto handled = connection_.handle_events(kStepS, done_); !handled) return handled;
    if (late && under_way_) return usb_failure(LIBUSB_ERROR_TIMEOUT, "writing", connection_.uri());
  }
  return {};
}

// A transfer that was complete at its timeout is a success, even if this program was delayed.
bool UsbOutflow::sent_whole() const {
  const bool ended =
      transfer_->status == LIBUSB_TRANSFER_COMPLETED || transfer_->status == LIBUSB_TRANSFER_TIMED_OUT;
  return ended && transfer_->actual_length == static_cast<int>(buffer_.size());
}

Result<void> UsbOutflow::clear() {
  const int code = libusb_clear_halt(connection_.handle(), connection_.interface().out);
  if (code == LIBUSB_ERROR_NO_DEVICE) return usb_failure(code, "writing", connection_.uri());
  return {};
}

}  // namespace tacto::firmware_host
