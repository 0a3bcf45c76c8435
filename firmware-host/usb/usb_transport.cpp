// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "firmware-host/usb/usb_words.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

using Clock = std::chrono::steady_clock;

constexpr auto kLongestDrain = std::chrono::seconds(2);
constexpr double kDrainStepS = 0.01;
constexpr auto kFirstPause = std::chrono::milliseconds(10);  // each one doubles: 0.3 s in all

std::string_view to_string(libusb_transfer_status status) {
  if (status == LIBUSB_TRANSFER_STALL) return "stalls";
  if (status == LIBUSB_TRANSFER_NO_DEVICE) return "disconnects and reconnects";
  return status == LIBUSB_TRANSFER_OVERFLOW ? "sends longer packets than it announced"
                                            : "sends unreadable transfers";
}

constexpr int kSendAttempts = 3;
constexpr double kStepS = 0.1;
constexpr auto kLongestFlush = std::chrono::seconds(2);

}  // namespace

UsbInflow::UsbInflow(const UsbConnection& connection)
    : connection_(connection), slots_(std::make_unique<std::vector<Slot>>(kTransfers)) {
  for (Slot& slot : *slots_) {
    slot.buffer.resize(kTransferBytes);
    slot.transfer.reset(libusb_alloc_transfer(0));
    libusb_transfer* const transfer = slot.transfer.get();
    if (!transfer) continue;
    libusb_fill_bulk_transfer(transfer, connection.handle(), connection.interface().in, slot.buffer.data(),
                              kTransferBytes, arrived, this, 0);
    idle_.push_back(transfer);
  }
}

// libusb may still write to a transfer that was not returned, so such a transfer is not freed.
UsbInflow::~UsbInflow() {
  cancel_all();
  const auto latest = Clock::now() + kLongestDrain;
  while (under_way_ > 0 && Clock::now() < latest)
    if (!wait(kDrainStepS)) break;
  if (under_way_ > 0) (void)slots_.release();
}

void UsbInflow::arrived(libusb_transfer* transfer) {
  static_cast<UsbInflow*>(transfer->user_data)->sort_in(transfer);
}

// A failed transfer may have received bytes before the failure. Only this class cancels transfers.
void UsbInflow::sort_in(libusb_transfer* transfer) {
  --under_way_;
  woken_ = 1;
  note(transfer->status);
  if (transfer->actual_length == 0) return idle_.push_back(transfer);
  full_.push_back(transfer);
  consecutive_errors_ = 0;
}

void UsbInflow::note(libusb_transfer_status status) {
  const bool good = status == LIBUSB_TRANSFER_COMPLETED || status == LIBUSB_TRANSFER_CANCELLED;
  if (!good && !trouble_) trouble_ = status;
}

void UsbInflow::end(const tl::unexpected<schema::Error>& reason) {
  if (!ended_) ended_ = reason.value();
}

Result<void> UsbInflow::keep_going() {
  while (!ended_) {
    if (!trouble_) submit_idle();
    if (!trouble_) break;
    cancel_all();
    if (under_way_ > 0) break;
    recover();
  }
  if (ended_) return tl::unexpected(*ended_);
  return {};
}

// Only while no transfer is pending: those queued after a stall would fail, too. A device that was reset by
// another program at first looks like an unplugged one, and an unplugged one like a bad cable, because hubs
// detect it late.
void UsbInflow::recover() {
  const auto trouble = *std::exchange(trouble_, std::nullopt);
  cancelled_ = false;
  if (++consecutive_errors_ > kMostTroubles) return give_up(trouble);
  if (trouble != LIBUSB_TRANSFER_STALL)
    std::this_thread::sleep_for(kFirstPause * (1 << (consecutive_errors_ - 1)));
  const int cleared = libusb_clear_halt(connection_.handle(), connection_.interface().in);
  if (cleared == LIBUSB_ERROR_NO_DEVICE) end(usb_failure(cleared, "reading", connection_.uri()));
}

void UsbInflow::give_up(libusb_transfer_status trouble) {
  end(schema::fail(schema::ErrorKind::device,
                   fmt::format("the device {}, {} times in a row", to_string(trouble), consecutive_errors_),
                   connection_.uri(),
                   "unplug it and plug it in again; if that does not help, try another cable"));
}

void UsbInflow::submit_idle() {
  while (!idle_.empty() && !trouble_ && !ended_) {
    const int code = libusb_submit_transfer(idle_.back());
    if (code == LIBUSB_ERROR_IO) trouble_ = LIBUSB_TRANSFER_ERROR;
    if (code != 0 && code != LIBUSB_ERROR_IO) end(usb_failure(code, "reading", connection_.uri()));
    if (code != 0) return;
    idle_.pop_back();
    ++under_way_;
  }
}

void UsbInflow::cancel_all() {
  if (std::exchange(cancelled_, true)) return;
  for (const Slot& slot : *slots_)
    if (slot.transfer) libusb_cancel_transfer(slot.transfer.get());
}

std::size_t UsbInflow::take(std::span<std::uint8_t> bytes) {
  if (full_.empty()) return 0;
  libusb_transfer* const first = full_.front();
  const auto there = static_cast<std::size_t>(first->actual_length);
  const std::size_t size = std::min(bytes.size(), there - used_);
  std::copy_n(first->buffer + used_, size, bytes.begin());
  used_ += size;
  if (used_ < there) return size;
  used_ = 0;
  full_.pop_front();
  idle_.push_back(first);
  return size;
}

Result<void> UsbInflow::wait(double timeout_s) {
  woken_ = 0;
  return connection_.handle_events(timeout_s, woken_);
}

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
