// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/usb/usb_device.hpp"

#include "firmware-host/link/wire_device.hpp"
#include "firmware-host/usb/usb_transport.hpp"

namespace tacto::firmware_host {

using schema::Result;

Result<std::unique_ptr<Device>> open_usb_device(const std::string&, std::string_view parameters) {
  const auto address = parse_usb_address(parameters);
  TACTO_TRY(address);
  auto connection = UsbConnection::open(*address);
  TACTO_TRY(connection);
  std::string uri = connection->uri();
  auto device = WireDevice::open(std::move(uri), std::make_unique<UsbTransport>(std::move(*connection)));
  TACTO_TRY(device);
  return std::unique_ptr<Device>(std::move(*device));
}

Result<std::vector<std::string>> usb_uris() {
  const auto context = begin_usb();
  TACTO_TRY(context);
  const auto found = find_usb(context->get());
  TACTO_TRY(found);
  const std::vector<UsbName> names = names_of(*found);
  std::vector<std::string> uris;
  for (std::size_t i = 0; i < names.size(); ++i) uris.push_back(usb_uri(names, i));
  return uris;
}

}  // namespace tacto::firmware_host
