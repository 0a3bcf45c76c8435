// SPDX-License-Identifier: GPL-3.0-or-later
// The gadget's main loop: a board's ticks held to the clock, its bytes to and from the cable.
#pragma once

#include <functional>

#include "firmware-host/gadget/drive_watch.hpp"
#include "firmware-host/gadget/fault_injector.hpp"
#include "firmware-host/gadget/gadget_board.hpp"
#include "firmware-host/gadget/tick_pacer.hpp"
#include "firmware-host/gadget/usb_link.hpp"

namespace tacto::firmware_host {

/// One thread. Where the host does not take what the board says, the board is not polled: as on a small
/// device, its ring fills and it counts what it loses. After a fault it says when the host was heard last,
/// what became of the drive, and when there is one again.
class GadgetLoop {
 public:
  GadgetLoop(GadgetBoard& board, UsbLink& link, const FaultPlan& faults,
             std::function<void(const std::string&)> say);

  /// Until `stopped` says so; looked at twenty times a second at least.
  void run(const std::function<bool()>& stopped);

 private:
  void exchange();
  void tick();
  void step();
  std::uint64_t due();

  GadgetBoard& board_;
  UsbLink& link_;
  FaultInjector faults_;
  std::function<void(const std::string&)> say_;
  TickPacer pacer_;
  DriveWatch drive_;
  bool told_slow_ = false;
};

}  // namespace tacto::firmware_host
