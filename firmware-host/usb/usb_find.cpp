// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_find.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>

#include "firmware-host/usb/usb_words.hpp"

namespace tacto::firmware_host {
namespace {

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

schema::Result<std::vector<UsbFound>> find_usb(libusb_context* context) {
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

}  // namespace tacto::firmware_host
