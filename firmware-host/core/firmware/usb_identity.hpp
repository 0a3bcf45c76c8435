// SPDX-License-Identifier: Apache-2.0
// By what a host knows a device on USB.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace tacto::usb {

/// One vendor-specific interface with one bulk endpoint each way. The host looks for these three numbers,
/// whatever the vendor and the product, and reads the endpoints' addresses from the descriptors.
inline constexpr uint8_t kInterfaceClass = 0xFF;     ///< vendor-specific
inline constexpr uint8_t kInterfaceSubclass = 0x54;  ///< 'T'
inline constexpr uint8_t kInterfaceProtocol = 0x01;  ///< the wire's major version
inline constexpr char kInterfaceName[] = "tactograph wire 1";

/// From pid.codes' range for tests and use in the house: not for devices that are given away. Their maker
/// takes numbers of his own.
inline constexpr uint16_t kTestVendor = 0x1209, kTestProduct = 0x0001;

/// Bytes of a bulk packet. A burst ends with a shorter one; where it is a multiple, with one of none.
inline constexpr size_t kFullSpeedPacket = 64, kHighSpeedPacket = 512, kSuperSpeedPacket = 1024;

}  // namespace tacto::usb
