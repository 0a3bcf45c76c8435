// SPDX-License-Identifier: Apache-2.0
// How a host recognises a device on USB.
#pragma once

#include <stddef.h>
#include <stdint.h>

namespace tacto::usb {

/// One vendor-specific interface with one bulk endpoint in each direction. The host searches for these three
/// numbers, for any vendor and product, and reads the endpoint addresses from the descriptors.
inline constexpr uint8_t kInterfaceClass = 0xFF;     ///< vendor-specific
inline constexpr uint8_t kInterfaceSubclass = 0x54;  ///< 'T'
inline constexpr uint8_t kInterfaceProtocol = 0x01;  ///< the wire's major version
inline constexpr char kInterfaceName[] = "tactograph wire 1";

/// From the pid.codes range for tests and private use: not for devices that are sold or given away, whose
/// makers use their own numbers.
inline constexpr uint16_t kTestVendor = 0x1209, kTestProduct = 0x0001;

/// The size of a bulk packet. A burst ends with a shorter packet, or with an empty one if its length is a
/// multiple.
inline constexpr size_t kFullSpeedPacket = 64, kHighSpeedPacket = 512, kSuperSpeedPacket = 1024;

}  // namespace tacto::usb
