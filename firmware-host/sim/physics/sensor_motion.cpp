// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/sim/physics/sensor_motion.hpp"

namespace tacto::firmware_host {

SensorMotion::SensorMotion(const schema::Transducer& t, const std::optional<SecondMode>& second_mode)
    : mechanics_(t, {.second_mode = second_mode, .finger_load = {}}),
      bender_n_per_m_(t.bender_stiffness_n_per_m),
      time_constant_s_(2 * t.sensor_resistance_ohm * t.capacitance_f),
      output_v_per_n_(t.sensor_scale * t.sensor_gain * t.deflection_m / (2 * t.max_voltage_v) /
                      t.capacitance_f) {}

}  // namespace tacto::firmware_host
