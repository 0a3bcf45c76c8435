// SPDX-License-Identifier: GPL-3.0-or-later
// The gadget's main loop: runs the board's ticks by the clock, and moves bytes between board and cable.
#pragma once

#include <functional>

#include "firmware-host/gadget/board_link.hpp"
#include "firmware-host/gadget/drive_watch.hpp"
#include "firmware-host/gadget/fault_injector.hpp"
#include "firmware-host/gadget/gadget_board.hpp"
#include "firmware-host/gadget/tick_pacer.hpp"

namespace tacto::firmware_host {

/// For one thread. If the host does not read, the board is not polled: as on a small device, its ring fills
/// and it counts its losses. After a fault it reports the last time of data from the host, the fall of the
/// drive, and the next rise of the drive.
class GadgetLoop {
 public:
  GadgetLoop(GadgetBoard& board, BoardLink& link, const FaultPlan& faults,
             std::function<void(const std::string&)> say);

  /// Runs until `stopped` returns true; it is called at least twenty times per second.
  void run(const std::function<bool()>& stopped);

 private:
  void exchange();
  void tick();
  void step();
  std::uint64_t due();

  GadgetBoard& board_;
  BoardLink& link_;
  FaultInjector faults_;
  std::function<void(const std::string&)> say_;
  TickPacer pacer_;
  DriveWatch drive_;
  bool told_slow_ = false;
};

}  // namespace tacto::firmware_host
