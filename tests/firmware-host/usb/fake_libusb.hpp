// SPDX-License-Identifier: GPL-3.0-or-later
// A USB bus that does what a test says, behind libusb's own functions: linked before the library, it takes
// its place. It watches how it is used: what is lent and not given back, transfers freed or devices closed
// while something is under way, endpoints cleared while they are in use.
#pragma once

#include <libusb.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace tacto::tests {

/// What happens next at an endpoint.
struct UsbEvent {
  enum Kind {
    data,      ///< bytes come, or are taken
    halt,      ///< it stalls until it is cleared
    error,     ///< a packet that nobody understands
    overflow,  ///< a packet too long
    reset,     ///< another program resets the device: what is under way ends as if the device were gone
    unplug,
    silence,  ///< of an OUT endpoint: it takes some bytes, and then none until the timeout
  };
  Kind kind = data;
  std::vector<std::uint8_t> bytes = {};  ///< that came, also before an error
};

struct FakeUsbDevice {
  std::string serial = "T1";
  std::uint8_t bus = 1;
  std::vector<std::uint8_t> ports = {2};
  std::uint8_t interface_class = 0xFF, interface_subclass = 0x54, protocol = 1;
  std::vector<std::uint8_t> endpoints = {0x81, 0x02};
  int open_code = 0, claim_code = 0;

  std::deque<UsbEvent> in, out;
  std::vector<std::uint8_t> taken;  ///< what the host sent
  bool plugged = true, in_halted = false, out_halted = false, claimed = false;
  std::deque<libusb_transfer*> in_under_way, out_under_way;
};

struct FakeUsb {
  std::deque<FakeUsbDevice> devices;
  int init_code = 0;
  int lent = 0;  ///< contexts, references, handles, descriptors, transfers
  int cleared = 0;
  std::vector<std::string> faults;  ///< how it was used wrongly
};

FakeUsb& fake_usb();

}  // namespace tacto::tests
