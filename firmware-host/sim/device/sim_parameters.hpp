// SPDX-License-Identifier: GPL-3.0-or-later
// What the emulated device is asked to be: "surface=C,speed=50mm/s,seed=1".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/bench/bench_errors.hpp"
#include "firmware-host/sim/bench/lvdt.hpp"
#include "firmware-host/sim/physics/finger_parameters.hpp"
#include "firmware-host/sim/physics/finger_path.hpp"
#include "firmware-host/sim/physics/known_force.hpp"
#include "firmware-host/sim/physics/surface.hpp"
#include "firmware-host/sim/physics/tray_physics.hpp"

namespace tacto::firmware_host {

struct SimParameters {
  SurfaceChoice surface;
  FingerParameters finger;
  BenchErrors errors;
  StrokePlan strokes;   ///< its ends are left to the device, which knows the surface's length
  double load_n = 0.5;  ///< Wiertlewski 2011, section IV-A5: 0.5 N and 50 mm/s
  bool finger_down = true;
  bool noise = true;
  std::uint64_t seed = 1;
  /// Whose finger: seeds the places of its ridges. Fingers differ; with this one the triangular grating of
  /// Figure 1 keeps its second harmonic above its fundamental for every seed from 1 to 20.
  std::uint64_t person = 1;
  double sample_rate_hz = 10e3;     ///< the paper's
  double encoder_quantum_m = 1e-6;  ///< the paper's
  std::string transducer = "wiertlewski2011";
  bool paced = false;  ///< by the clock on the wall, as a real device is
  std::string serial;  ///< empty: made of the seed. Not a key of the URI
  /// Paced: for how long the host's side of the cable takes what nobody reads. Then the device loses frames,
  /// as a real one does. Without it, emulated time waits for the reader.
  std::optional<double> link_buffer_s;

  bool counter = false;  ///< frames that count themselves, instead of physics
  int channels = 4;      ///< of the counter

  bool known_force = false;  ///< pulls on the tray instead of the finger
  ForcePlan force;

  bool has_lvdt = false;  ///< gives the position instead of the encoder
  LvdtParameters lvdt;

  bool has_second_mode = false, has_finger_load = false;
  SecondMode second_mode;
  FingerLoad finger_load;
  double hysteresis = 0;

  bool has_reconstruction = false;  ///< a filter behind the drive's converter
  double reconstruction_cutoff_hz = 600;

  bool has_tray_sensor = false;  ///< a channel `displacement`: where the driven tray is
  double tray_sensor_noise_m = 20e-9;
  TrayPhysics tray() const;
  bool watches_tray() const { return has_tray_sensor && !counter; }
};

/// Reads key=value pairs between commas; a quantity has its unit. Keys that are absent keep their defaults.
/// Errors: usage: a key that does not exist (with those that do), one that comes twice, a value that is no
/// such quantity or out of its range (with the range), one that means nothing without another.
schema::Result<SimParameters> parse_sim_parameters(std::string_view text);

/// What only the whole shows. Errors: usage: a second mode that is not above the tray's resonance, a force
/// above half the rate or with its band upside down, a surface beyond the LVDT's range.
schema::Result<void> check_against(const SimParameters& parameters, const schema::Transducer& transducer,
                                   double surface_length_m);

/// The keys, each with meaning and default, one a line, for help.
std::string sim_parameters_help();

}  // namespace tacto::firmware_host
