// SPDX-License-Identifier: GPL-3.0-or-later
// One run of the emulated device, from its first frame on.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "data-schema/transducer/transducer.hpp"
#include "firmware-host/sim/bench/bench.hpp"
#include "firmware-host/sim/bench/lvdt.hpp"
#include "firmware-host/sim/device/sim_parameters.hpp"
#include "firmware-host/sim/physics/converter.hpp"
#include "firmware-host/sim/physics/finger_path.hpp"
#include "firmware-host/sim/physics/height_profile.hpp"
#include "firmware-host/sim/physics/random.hpp"
#include "firmware-host/sim/physics/spline_noise.hpp"

namespace tacto::firmware_host {

// The interface of the emulated device's sources of frames.

class FrameSource {
 public:
  FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  /// Computes one sample period, and the frame at its end: one code per channel. False if it cannot continue.
  virtual bool next(std::span<std::int32_t> frame) = 0;
  /// The count of the encoder at the end of that period.
  virtual std::int32_t encoder_count() const = 0;
};

/// After the ATI Nano17 of Wiertlewski 2011, section III-D (calibration SI-12-0.12: 12 N tangentially, 17 N
/// normally, resolution 1/320 N): slow, and much noisier than the piezo. A first-order low-pass, noise of the
/// size of the resolution, 16 bits; sampled about 1000 times per second and held in between.
class LoadCell {
 public:
  LoadCell(double range_n, double sample_rate_hz, bool noise, Random random);

  /// The code for one sample of the recording.
  std::int32_t step(double force_n);
  const Converter& converter() const { return converter_; }
  double native_rate_hz() const { return native_rate_hz_; }

 private:
  Converter converter_;
  Random random_;
  int every_;
  double native_rate_hz_, follow_, noise_n_;
  double filtered_n_ = 0;
  int until_next_ = 0;
  std::int32_t held_ = 0;
};

/// The bench (a finger on a surface, or a known force) and its instruments: the piezo's converter with the
/// noise floor before it, the encoder or LVDT, the load cell's axes, and with a known force a cell that is as
/// fast as the converter. Frame i is at (i + 1) / rate seconds.
class SimRun final : public FrameSource {
 public:
  SimRun(const SimParameters& parameters, const schema::Transducer& transducer, const HeightProfile& profile);

  /// Codes of tangential_force, position, normal_force, net_force, and applied_force if it is known. False if
  /// the simulated motion has diverged.
  bool next(std::span<std::int32_t> frame) override;
  std::int32_t encoder_count() const override { return count_; }
  const LoadCell& normal_cell() const { return normal_cell_; }
  const LoadCell& net_cell() const { return net_cell_; }
  const Converter& converter() const { return converter_; }
  /// Null with a finger.
  const Converter* reference_cell() const { return reference_cell_ ? &*reference_cell_ : nullptr; }
  /// Null if the encoder measures the position.
  const Lvdt* lvdt() const { return lvdt_ ? &*lvdt_ : nullptr; }

 private:
  double load_n(const FingerPlace& place);
  std::int32_t count_at(double position_m) const;

  SimParameters parameters_;
  FingerPath path_;
  SplineNoise load_wander_;
  std::unique_ptr<Bench> bench_;
  Random noise_;
  double noise_v_;
  Converter converter_;
  LoadCell normal_cell_, net_cell_;
  std::optional<Converter> reference_cell_;
  std::optional<Lvdt> lvdt_;
  std::int32_t count_;
  std::uint64_t frames_ = 0;
};

}  // namespace tacto::firmware_host
