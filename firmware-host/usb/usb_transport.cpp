// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_transport.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <libusb.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "data-schema/base/error.hpp"
#include "data-schema/base/open_by.hpp"
#include "firmware-host/core/firmware/usb_identity.hpp"

namespace tacto::firmware_host {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;
using Clock = std::chrono::steady_clock;

// Messages for libusb's errors, with the remedy.

// `code` is a libusb_error; `doing` is the operation, as in "opening the device". "Not permitted" becomes
// not_found, as for files; all others become device.
tl::unexpected<schema::Error> usb_failure(int code, std::string_view doing, const std::string& where) {
  switch (code) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return fail(ErrorKind::device, "the device was unplugged", where, "check its cable and its supply");
    case LIBUSB_ERROR_ACCESS:
      return fail(ErrorKind::not_found, "this user may not open the device", where,
                  "install the udev rule 60-tactograph.rules ('cmake --install', or copy it to "
                  "/etc/udev/rules.d), then unplug it and plug it in again");
    case LIBUSB_ERROR_BUSY:
      return fail(ErrorKind::device, "another program uses the device", where, "stop that program");
    case LIBUSB_ERROR_NO_MEM:
      return fail(ErrorKind::device, "the system has no memory for USB transfers", where,
                  "close other USB programs, or raise /sys/module/usbcore/parameters/usbfs_memory_mb");
    default:
      return fail(ErrorKind::device, fmt::format("{} failed: {}", doing, libusb_strerror(code)), where,
                  "unplug it and plug it in again, at another port or with another cable");
  }
}

constexpr std::string_view kSerialKey = "serial=", kPortKey = "port=";

std::vector<std::string> uris_of(const std::vector<UsbName>& names) {
  std::vector<std::string> uris;
  for (std::size_t i = 0; i < names.size(); ++i) uris.push_back(usb_uri(names, i));
  return uris;
}

bool meant(const UsbName& name, const UsbAddress& address) {
  if (!address.serial.empty()) return name.serial == address.serial;
  return address.port.empty() || name.port == address.port;
}

tl::unexpected<schema::Error> not_there(const std::vector<UsbName>& names, const UsbAddress& address) {
  if (names.empty())
    return fail(
        ErrorKind::not_found, "no device was found on USB", "device",
        "plug it in and switch it on; 'tactograph scan' lists available devices, including emulated ones");
  const bool by_serial = !address.serial.empty();
  return fail(ErrorKind::not_found,
              by_serial ? fmt::format("no device on USB has the serial number '{}'", address.serial)
                        : fmt::format("no device was found on USB port '{}'", address.port),
              "device", fmt::format("devices on USB: {}", fmt::join(uris_of(names), ", ")));
}

bool is_wire(const libusb_interface_descriptor& descriptor) {
  return descriptor.bInterfaceClass == usb::kInterfaceClass &&
         descriptor.bInterfaceSubClass == usb::kInterfaceSubclass;
}

bool is_bulk(const libusb_endpoint_descriptor& endpoint) {
  return (endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) == LIBUSB_TRANSFER_TYPE_BULK;
}

// Endpoint 0 is never a bulk endpoint, so that zero means "none".
void take_endpoint(const libusb_endpoint_descriptor& endpoint, UsbInterface& found) {
  if (!is_bulk(endpoint)) return;
  const bool inwards = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_DIR_MASK) == LIBUSB_ENDPOINT_IN;
  (inwards ? found.in : found.out) = endpoint.bEndpointAddress;
}

UsbInterface described_by(const libusb_interface_descriptor& descriptor) {
  UsbInterface found;
  found.number = descriptor.bInterfaceNumber;
  found.setting = descriptor.bAlternateSetting;
  for (const auto& endpoint : std::span(descriptor.endpoint, descriptor.bNumEndpoints))
    take_endpoint(endpoint, found);
  return found;
}

constexpr int kMostPorts = 7;  // number of hubs before a device, by the USB 3.0 specification

std::string port_of(libusb_device* device) {
  std::uint8_t ports[kMostPorts];
  const int count = libusb_get_port_numbers(device, ports, kMostPorts);
  std::string port = fmt::format("{}", libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i) port += fmt::format("{}{}", i == 0 ? '-' : '.', ports[i]);
  return port;
}

tl::unexpected<schema::Error> busy(libusb_device* device, const std::string& where) {
  schema::Error error = usb_failure(LIBUSB_ERROR_BUSY, "claiming its interface", where).value();
  const std::string node = fmt::format("/dev/bus/usb/{:03}/{:03}", libusb_get_bus_number(device),
                                       libusb_get_device_address(device));
  error.remedy = "stop " + schema::programs_with(node, "that program");
  return tl::unexpected(std::move(error));
}

// A serial that cannot be read is empty: opening the device will return the reason.
std::string serial_of(libusb_device* device) {
  libusb_device_descriptor about{};
  libusb_device_handle* opened = nullptr;
  if (libusb_get_device_descriptor(device, &about) != 0 || about.iSerialNumber == 0) return {};
  if (libusb_open(device, &opened) != 0) return {};
  const UsbPointer<libusb_device_handle> handle(opened);
  unsigned char text[128];
  const int size = libusb_get_string_descriptor_ascii(handle.get(), about.iSerialNumber, text, sizeof text);
  return size > 0 ? std::string(text, text + size) : std::string();
}

// The first interface with the wire's class and subclass (core/firmware/usb_identity.hpp) and one bulk
// endpoint in each direction. With any protocol number, so that a device of another version can be refused
// by name.
std::optional<UsbInterface> wire_interface(const libusb_config_descriptor& configuration) {
  for (const auto& interface : std::span(configuration.interface, configuration.bNumInterfaces))
    for (const auto& setting :
         std::span(interface.altsetting, static_cast<std::size_t>(interface.num_altsetting))) {
      if (!is_wire(setting)) continue;
      const UsbInterface found = described_by(setting);
      if (found.in != 0 && found.out != 0) return found;
    }
  return std::nullopt;
}

std::optional<UsbInterface> interface_of(libusb_device* device) {
  libusb_config_descriptor* descriptor = nullptr;
  if (libusb_get_active_config_descriptor(device, &descriptor) != 0) return std::nullopt;
  const UsbPointer<libusb_config_descriptor> configuration(descriptor);
  return wire_interface(*configuration);
}

std::vector<UsbFound> ours_among(std::span<libusb_device*> devices) {
  std::vector<UsbFound> found;
  for (libusb_device* device : devices)
    if (const auto interface = interface_of(device))
      found.push_back({{serial_of(device), port_of(device)},
                       *interface,
                       UsbPointer<libusb_device>(libusb_ref_device(device))});
  std::sort(found.begin(), found.end(),
            [](const UsbFound& a, const UsbFound& b) { return a.name.port < b.name.port; });
  return found;
}

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

Result<UsbAddress> parse_usb_address(std::string_view parameters) {
  UsbAddress address;
  if (parameters.empty()) return address;
  const bool by_serial = parameters.starts_with(kSerialKey), by_port = parameters.starts_with(kPortKey);
  const std::string value(parameters.substr(by_serial ? kSerialKey.size() : by_port ? kPortKey.size() : 0));
  if ((!by_serial && !by_port) || value.empty() || value.find(',') != std::string::npos)
    return fail(
        ErrorKind::usage, fmt::format("'{}' is not an address of a device on USB", parameters), "device",
        "give usb: (if there is only one), usb:serial=XYZ or usb:port=1-2; 'tactograph scan' lists them");
  (by_serial ? address.serial : address.port) = value;
  return address;
}

std::string usb_uri(const std::vector<UsbName>& names, std::size_t index) {
  const UsbName& one = names[index];
  const bool alone = std::count_if(names.begin(), names.end(),
                                   [&](const UsbName& other) { return other.serial == one.serial; }) == 1;
  const bool tells = alone && !one.serial.empty() && one.serial.find(',') == std::string::npos;
  return tells ? fmt::format("usb:{}{}", kSerialKey, one.serial)
               : fmt::format("usb:{}{}", kPortKey, one.port);
}

Result<std::size_t> choose_usb(const std::vector<UsbName>& names, const UsbAddress& address) {
  const auto target = [&](const UsbName& name) { return meant(name, address); };
  const auto found = std::find_if(names.begin(), names.end(), target);
  if (found == names.end()) return not_there(names, address);
  if (std::count_if(names.begin(), names.end(), target) > 1)
    return fail(ErrorKind::usage, fmt::format("there are {} devices on USB", names.size()), "device",
                fmt::format("choose one with -d: {}", fmt::join(uris_of(names), ", ")));
  return static_cast<std::size_t>(found - names.begin());
}

Result<std::vector<UsbFound>> find_usb(libusb_context* context) {
  libusb_device** list = nullptr;
  const auto count = libusb_get_device_list(context, &list);
  if (count < 0) return usb_failure(static_cast<int>(count), "looking for devices on USB", "device");
  std::vector<UsbFound> found = ours_among(std::span(list, static_cast<std::size_t>(count)));
  libusb_free_device_list(list, 1);
  return found;
}

std::vector<UsbName> names_of(const std::vector<UsbFound>& found) {
  std::vector<UsbName> names;
  names.reserve(found.size());
  for (const UsbFound& one : found) names.push_back(one.name);
  return names;
}

Result<std::shared_ptr<libusb_context>> begin_usb() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != 0)
    return usb_failure(code, "initialising USB", "device");
  return std::shared_ptr<libusb_context>(context, UsbDeleter());
}

// The connection is created first, because it owns the libusb session of the found devices.
Result<UsbConnection> UsbConnection::open(const UsbAddress& address) {
  auto context = begin_usb();
  TACTO_TRY(context);
  UsbConnection connection;
  connection.context_ = std::move(*context);
  const auto found = find_usb(connection.context_.get());
  TACTO_TRY(found);
  const std::vector<UsbName> names = names_of(*found);
  const auto chosen = choose_usb(names, address);
  TACTO_TRY(chosen);
  connection.uri_ = usb_uri(names, *chosen);
  TACTO_TRY(connection.claim((*found)[*chosen]));
  return connection;
}

// Detaches a kernel driver if the system supports it; otherwise claiming returns "busy".
Result<void> UsbConnection::claim(const UsbFound& found) {
  interface_ = found.interface;
  libusb_device_handle* handle = nullptr;
  const int opened = libusb_open(found.device.get(), &handle);
  if (opened != 0) return usb_failure(opened, "opening the device", uri_);
  handle_.reset(handle);
  libusb_set_auto_detach_kernel_driver(handle, 1);
  const int claimed = libusb_claim_interface(handle, interface_.number);
  if (claimed == LIBUSB_ERROR_BUSY) return busy(found.device.get(), uri_);
  if (claimed != 0) return usb_failure(claimed, "claiming its interface", uri_);
  if (interface_.setting == 0) return {};
  const int set = libusb_set_interface_alt_setting(handle, interface_.number, interface_.setting);
  if (set != 0) return usb_failure(set, "selecting the setting of its interface", uri_);
  return {};
}

UsbConnection::~UsbConnection() {
  if (handle_) libusb_release_interface(handle(), interface_.number);
}

Result<void> UsbConnection::handle_events(double timeout_s, int& done) const {
  timeval time{};
  time.tv_sec = static_cast<time_t>(timeout_s);
  time.tv_usec = static_cast<suseconds_t>((timeout_s - std::floor(timeout_s)) * 1e6);
  const int code = libusb_handle_events_timeout_completed(context_.get(), &time, &done);
  if (code != 0 && code != LIBUSB_ERROR_INTERRUPTED) return usb_failure(code, "waiting for the device", uri_);
  return {};
}

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
