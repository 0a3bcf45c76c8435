// SPDX-License-Identifier: GPL-3.0-or-later
// The board of the gadget: the firmware's core, with a source of samples behind its hardware layer.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "firmware-host/core/firmware/drive_supervisor.hpp"

namespace tacto::firmware_host {

/// For one thread. Frames are passed through memory: each call of poll() appends whole frames to to_host(). A
/// maker's board is a class like ReplayBoard, with calls of its converters in step().
class GadgetBoard {
 public:
  virtual ~GadgetBoard() = default;

  /// As in the welcome.
  virtual std::string serial() const = 0;
  virtual bool ticking() const = 0;
  /// Precondition: ticking().
  virtual double period_s() const = 0;
  /// Computes one sample period, and the core's tick. Precondition: ticking().
  virtual void step() = 0;
  /// One pass of the core's main loop.
  virtual void poll() = 0;
  /// Of the last tick: the output of the converter (V), and the state of the core.
  virtual double drive_v() const = 0;
  virtual const core::DriveSupervisor& supervisor() const = 0;
  virtual std::vector<std::uint8_t>& from_host() = 0;
  virtual std::vector<std::uint8_t>& to_host() = 0;
};

/// By URI: `sim:...` (physics; see sim/device/sim_parameters.hpp) or `replay:FILE` (a recording's codes, tick
/// by tick; `,loop=1`: repeated). With an empty `serial` the board uses its own. Errors: usage: no such
/// board; as parse_sim_parameters(), open_recording(); unsuitable: a recording that a device cannot play.
schema::Result<std::unique_ptr<GadgetBoard>> make_gadget_board(const std::string& uri,
                                                               const std::string& serial);

}  // namespace tacto::firmware_host
