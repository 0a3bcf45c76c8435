// SPDX-License-Identifier: GPL-3.0-or-later
// The axes of an emulated force device, with a hand on each of them, under forces that are held between
// ticks.
#pragma once

#include <deque>
#include <vector>

#include "data-schema/device/device.hpp"
#include "data-schema/device/hand.hpp"
#include "firmware-host/sim/planar/axis_motion.hpp"

namespace tacto::firmware_host {

/// Each axis moves by itself (axis_motion.hpp): the masses of axis and hand, the axis's friction, the hand's
/// damper to the ground and its spring to the place to which the person moves it. A force changes `delay_s`
/// after its tick. At an end of the travel the axis stops.
class PlanarBody {
 public:
  PlanarBody(const schema::Device& device, const schema::Hand& hand, double period_s);

  /// At rest at these places, without forces. One number per axis, here and below.
  void rest_at(const std::vector<double>& place_m);
  /// In motion, without forces of the device; from now on a constant external force acts on it.
  void start_at(const std::vector<double>& place_m, const std::vector<double>& speed_mps,
                const std::vector<double>& push_n);
  /// Moves over one period, in which the hand's places move evenly, after a tick with these forces (N, on the
  /// hand).
  void step(const std::vector<double>& force_n, const std::vector<double>& hand_from_m,
            const std::vector<double>& hand_to_m);
  double place_m(std::size_t axis) const { return states_[axis].place_m; }
  /// The nearest count of the encoder.
  std::int32_t count(std::size_t axis) const;

 private:
  double force_of(std::size_t axis, std::size_t ticks_ago) const;

  schema::Device device_;
  std::vector<AxisBody> bodies_;
  std::vector<PlaceAndSpeed> states_;
  std::vector<double> push_n_;
  double period_s_, late_s_;                  // the part of the delay within a period
  std::size_t late_ticks_;                    // and its whole periods
  std::deque<std::vector<double>> forces_n_;  // of the last ticks, the newest first
};

/// The nearest count of an encoder; of a place that is no number the least one: a jump, which the firmware
/// answers with a fault.
std::int32_t encoder_count(const schema::DeviceAxis& axis, double place_m);

}  // namespace tacto::firmware_host
