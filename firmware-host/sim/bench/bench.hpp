// SPDX-License-Identifier: GPL-3.0-or-later
// What lies under the instruments: something that pulls on the transducer's tray.
#pragma once

#include "firmware-host/sim/physics/finger_path.hpp"

namespace tacto::firmware_host {

/// What the bench's instruments see at the end of a step.
struct BenchReading {
  double sensor_v = 0;
  double tangential_n = 0;  ///< f_d: the force on the tray along +x
  double normal_n = 0;
  double position_m = 0;  ///< of the finger's bone
};

class Bench {
 public:
  Bench() = default;
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;
  virtual ~Bench() = default;

  /// One sample period with the bone going evenly from where it was to `bone`, under a load (0: no contact).
  /// False, and nothing changed, where the motion has diverged.
  virtual bool step(const FingerPlace& bone, double load_n) = 0;
  virtual BenchReading reading() const = 0;
};

/// The longest step of the equations of motion.
inline constexpr double kLongestStepS = 12.5e-6;

/// Steps of at most kLongestStepS in a period.
int substeps_in(double period_s);

}  // namespace tacto::firmware_host
