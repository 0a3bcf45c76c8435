// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_interface.hpp"

#include <libusb.h>

#include <span>

#include "firmware-host/core/firmware/usb_identity.hpp"

namespace tacto::firmware_host {
namespace {

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

}  // namespace

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

}  // namespace tacto::firmware_host
