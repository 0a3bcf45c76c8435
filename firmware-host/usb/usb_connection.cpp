// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_connection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "firmware-host/core/firmware/usb_identity.hpp"
#include "firmware-host/usb/usb_words.hpp"

namespace tacto::firmware_host {
namespace {

using schema::Result;

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

}  // namespace

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

}  // namespace tacto::firmware_host
