// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters of the emulated device: "surface=C,speed=50mm/s,seed=1".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/bench/lvdt.hpp"
#include "firmware-host/sim/physics/finger_parameters.hpp"
#include "firmware-host/sim/physics/finger_path.hpp"
#include "firmware-host/sim/physics/known_force.hpp"
#include "firmware-host/sim/physics/surface.hpp"
#include "firmware-host/sim/physics/tray_physics.hpp"

namespace tacto::firmware_host {

/// A gain of 1.02 gives 2 % more volts, codes or counts than the nominal scale of the device. Known loads act
/// on the load cell permanently; the high-pass of the piezo removes them.
struct BenchErrors {
  double sensor_gain = 1, cell_gain = 1, encoder_gain = 1;
  double cell_zero_n = 0;  ///< both axes without load
  double weight_n = 0;     ///< known, down on the tray
  double pull_n = 0;       ///< known, along +x
  double mains_v = 0;      ///< peak at the converter of the piezo, 50 Hz; a third of it at 150 Hz
  double clock_ppm = 0;    ///< error of the device's clock; positive: fast
};

/// Mains pick-up, in volts.
inline double mains_at(double mains_v, double time_s) {
  const double turns = 50 * time_s;
  return mains_v == 0 ? 0 : mains_v * (sine_of_turns(turns) + sine_of_turns(3 * turns) / 3);
}

struct SimParameters {
  SurfaceChoice surface;
  FingerParameters finger;
  BenchErrors errors;
  StrokePlan strokes;   ///< the device sets its ends from the length of the surface
  double load_n = 0.5;  ///< Wiertlewski 2011, section IV-A5: 0.5 N and 50 mm/s
  bool finger_down = true;
  bool noise = true;
  std::uint64_t seed = 1;
  /// The seed of the ridges' positions. Fingers differ; with this one the second harmonic of the triangular
  /// grating of Figure 1 is above its fundamental for every seed from 1 to 20.
  std::uint64_t person = 1;
  double sample_rate_hz = 10e3;     ///< the paper's
  double encoder_quantum_m = 1e-6;  ///< the paper's
  std::string transducer = "wiertlewski2011";
  bool paced = false;  ///< by the wall clock, as a real device
  std::string serial;  ///< empty: made from the seed. Not a key of the URI
  /// Paced: for how long the host's side of the cable buffers data that are not read. After that the device
  /// loses frames, as a real one. Without it, emulated time waits for the reader.
  std::optional<double> link_buffer_s;

  bool counter = false;  ///< frames with consecutive numbers instead of physics
  int channels = 4;      ///< of the counter

  bool known_force = false;  ///< acts on the tray instead of the finger
  ForcePlan force;

  bool has_lvdt = false;  ///< measures the position instead of the encoder
  LvdtParameters lvdt;

  bool has_second_mode = false, has_finger_load = false;
  SecondMode second_mode;
  FingerLoad finger_load;
  double hysteresis = 0;

  bool has_reconstruction = false;  ///< a filter after the drive's converter
  double reconstruction_cutoff_hz = 600;

  bool has_tray_sensor = false;  ///< a channel `displacement`: the position of the driven tray
  double tray_sensor_noise_m = 20e-9;
  TrayPhysics tray() const;
  bool watches_tray() const { return has_tray_sensor && !counter; }
};

/// Reads key=value pairs between commas; a quantity has its unit. Keys that are absent keep their defaults.
/// Errors: usage: a key that does not exist (with the nearest one), a repeated key, a value of the wrong kind
/// or out of its range (with the range), a key that requires another one.
schema::Result<SimParameters> parse_sim_parameters(std::string_view text);

/// Checks that need all parameters. Errors: usage: a second mode that is not above the tray's resonance, a
/// force above half the rate or with low above high, a surface beyond the LVDT's range.
schema::Result<void> check_against(const SimParameters& parameters, const schema::Transducer& transducer,
                                   double surface_length_m);

/// The keys with meaning and default, one per line, for help.
std::string sim_parameters_help();

}  // namespace tacto::firmware_host
