// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated USB bus behind libusb's functions: linked before the library, it replaces it. It also detects
// wrong use: objects that are not returned, transfers freed or devices closed while a transfer is under way,
// endpoints cleared while they are in use.
#pragma once

#include <libusb.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace tacto::tests {

/// The next event at an endpoint.
struct UsbEvent {
  enum Kind {
    data,      ///< bytes arrive, or are accepted
    halt,      ///< the endpoint stalls until it is cleared
    error,     ///< a corrupted packet
    overflow,  ///< a packet too long
    reset,     ///< another program resets the device: transfers under way end as if the device were unplugged
    unplug,
    silence,  ///< for an OUT endpoint: it accepts some bytes, and then none until the timeout
  };
  Kind kind = data;
  std::vector<std::uint8_t> bytes = {};  ///< that arrived, also before an error
};

struct FakeUsbDevice {
  std::string serial = "T1";
  std::uint8_t bus = 1;
  std::vector<std::uint8_t> ports = {2};
  std::uint8_t interface_class = 0xFF, interface_subclass = 0x54, protocol = 1;
  std::vector<std::uint8_t> endpoints = {0x81, 0x02};
  int open_code = 0, claim_code = 0;

  std::deque<UsbEvent> in, out;
  std::vector<std::uint8_t> taken;  ///< bytes from the host
  bool plugged = true, in_halted = false, out_halted = false, claimed = false;
  std::deque<libusb_transfer*> in_under_way, out_under_way;
};

struct FakeUsb {
  std::deque<FakeUsbDevice> devices;
  int init_code = 0;
  int lent = 0;  ///< contexts, references, handles, descriptors, transfers
  int cleared = 0;
  std::vector<std::string> faults;  ///< wrong uses
};

FakeUsb& fake_usb();

}  // namespace tacto::tests
