// SPDX-License-Identifier: GPL-3.0-or-later
// What the gadget runs: the firmware's core, with samples from somewhere behind its hardware layer.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "firmware-host/core/firmware/drive_supervisor.hpp"

namespace tacto::firmware_host {

/// One thread calls it. Frames go through memory: each call of poll() adds whole frames to to_host(). A
/// maker's board is a class like ReplayBoard, with his converters in step().
class GadgetBoard {
 public:
  virtual ~GadgetBoard() = default;

  /// As the welcome says it.
  virtual std::string serial() const = 0;
  virtual bool ticking() const = 0;
  /// Precondition: ticking().
  virtual double period_s() const = 0;
  /// One sample period, and the core's tick. Precondition: ticking().
  virtual void step() = 0;
  /// The core's main loop, once.
  virtual void poll() = 0;
  /// Of the last tick: what the converter was given (V), and what the core says of it.
  virtual double drive_v() const = 0;
  virtual const core::DriveSupervisor& supervisor() const = 0;
  virtual std::vector<std::uint8_t>& from_host() = 0;
  virtual std::vector<std::uint8_t>& to_host() = 0;
};

/// By URI: `sim:...` (physics; see sim/sim_parameters.hpp) or `replay:FILE` (a recording's codes, tick by
/// tick; `,loop=1`: again and again). An empty `serial` leaves the board its own. Errors: usage: no such
/// board; as parse_sim_parameters(), open_recording(); unsuitable: a recording that no device can give.
schema::Result<std::unique_ptr<GadgetBoard>> make_gadget_board(const std::string& uri,
                                                               const std::string& serial);

}  // namespace tacto::firmware_host
