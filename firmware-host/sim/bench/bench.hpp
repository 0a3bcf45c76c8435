// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of the benches: a source of force on the transducer's tray.
#pragma once

#include "firmware-host/sim/physics/finger_path.hpp"

namespace tacto::firmware_host {

/// The quantities that the bench's instruments measure at the end of a step.
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

  /// Computes one sample period in which the bone moves linearly to `bone`, under a load (0: no contact).
  /// Returns false, without any change, if the motion has diverged.
  virtual bool step(const FingerPlace& bone, double load_n) = 0;
  virtual BenchReading reading() const = 0;
};

/// The longest step of the equations of motion.
inline constexpr double kLongestStepS = 12.5e-6;

/// The number of steps of at most kLongestStepS in a period.
int substeps_in(double period_s);

}  // namespace tacto::firmware_host
