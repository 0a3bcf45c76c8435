// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/gadget/functionfs_descriptors.hpp"

#include <linux/usb/functionfs.h>

#include <initializer_list>

#include "firmware-host/core/firmware/usb_identity.hpp"

namespace tacto::firmware_host {
namespace {

constexpr std::uint8_t kInEndpoint = 0x81, kOutEndpoint = 0x02;  // the kernel may assign others
constexpr std::uint16_t kEnglish = 0x0409;

/// Little-endian on every machine, as USB and FunctionFS require.
class Bytes {
 public:
  void u8(std::initializer_list<std::uint8_t> values) { bytes_.insert(bytes_.end(), values); }
  void u16(std::uint16_t value) {
    u8({static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)});
  }
  void u32(std::uint32_t value) {
    u16(static_cast<std::uint16_t>(value));
    u16(static_cast<std::uint16_t>(value >> 16));
  }
  void text(std::string_view text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }
  /// Writes the total size into the header.
  std::vector<std::uint8_t> with_length_at(std::size_t place) {
    for (std::size_t i = 0; i < 4; ++i)
      bytes_[place + i] = static_cast<std::uint8_t>(bytes_.size() >> (8 * i));
    return std::move(bytes_);
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

void add_endpoint(Bytes& bytes, std::uint8_t address, std::size_t packet) {
  bytes.u8({USB_DT_ENDPOINT_SIZE, USB_DT_ENDPOINT, address, USB_ENDPOINT_XFER_BULK});
  bytes.u16(static_cast<std::uint16_t>(packet));
  bytes.u8({0});
  if (packet != usb::kSuperSpeedPacket) return;
  bytes.u8({USB_DT_SS_EP_COMP_SIZE, USB_DT_SS_ENDPOINT_COMP, 0, 0, 0, 0});
}

void add_interface(Bytes& bytes, std::size_t packet) {
  bytes.u8({USB_DT_INTERFACE_SIZE, USB_DT_INTERFACE, 0, 0, 2, usb::kInterfaceClass, usb::kInterfaceSubclass,
            usb::kInterfaceProtocol, 1});
  add_endpoint(bytes, kInEndpoint, packet);
  add_endpoint(bytes, kOutEndpoint, packet);
}

}  // namespace

std::vector<std::uint8_t> functionfs_descriptors() {
  Bytes bytes;
  bytes.u32(FUNCTIONFS_DESCRIPTORS_MAGIC_V2);
  bytes.u32(0);
  bytes.u32(FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC | FUNCTIONFS_HAS_SS_DESC);
  for (const std::uint32_t descriptors : {3, 3, 5}) bytes.u32(descriptors);
  for (const std::size_t packet : {usb::kFullSpeedPacket, usb::kHighSpeedPacket, usb::kSuperSpeedPacket})
    add_interface(bytes, packet);
  return bytes.with_length_at(4);
}

std::vector<std::uint8_t> functionfs_strings(std::string_view interface_name) {
  Bytes bytes;
  bytes.u32(FUNCTIONFS_STRINGS_MAGIC);
  bytes.u32(0);
  bytes.u32(1);
  bytes.u32(1);
  bytes.u16(kEnglish);
  bytes.text(interface_name);
  bytes.u8({0});
  return bytes.with_length_at(4);
}

}  // namespace tacto::firmware_host
