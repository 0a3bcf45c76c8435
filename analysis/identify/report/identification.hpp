// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a transducer file from identification results.
#pragma once

#include <functional>
#include <string>

#include "analysis/identify/fit/hysteresis_loop.hpp"
#include "analysis/identify/fit/joint_fit.hpp"
#include "analysis/identify/fit/response_fit.hpp"
#include "analysis/identify/measure/device_drive.hpp"
#include "analysis/identify/measure/excitation.hpp"
#include "analysis/identify/measure/taps.hpp"

namespace tacto::analysis {

enum class IdentifyMethod { sweep, multisine, chirp, loop, taps, joint, contact };

/// A response, and the drive of its measurement.
struct DrivenResponse {
  BodeData data;
  SweptDrive drive;
};

/// The highest frequency of a sweep over the rate.
inline constexpr double kMostOfRate = 0.45;

/// Measures the actuator's response on a device by sweep, multisine or chirp. Errors: those of drive_tray();
/// unsuitable: an amplitude that exceeds the limits by the base's prediction.
schema::Result<DrivenResponse> driven_response(firmware_host::Device& device, IdentifyMethod method,
                                               const ExcitationPlan& plan, const schema::Transducer& base,
                                               const std::function<bool()>& stop_asked,
                                               const std::function<void(double)>& progress);
/// The response alone.
schema::Result<BodeData> measured_on(firmware_host::Device& device, IdentifyMethod method,
                                     const ExcitationPlan& plan, const schema::Transducer& base,
                                     const std::function<bool()>& stop_asked,
                                     const std::function<void(double)>& progress);

/// Default amplitude of slow loops: the largest within the limits of drive and displacement.
double loop_amplitude_v(const schema::Transducer& base);
/// Peak of a sweep that is combined with such loops: a fifth of their amplitude, or nine tenths of what the
/// limits of slew and displacement allow in the plan's band.
double joint_amplitude_v(const ExcitationPlan& plan, const schema::Transducer& base);

/// The base transducer with the fitted values, a new name, the date, the valid band and the result of the
/// fit. If the base's linear model is kept (finger, loops, taps), the doubts of its identification are kept,
/// too.
schema::Transducer identified(const ResponseFit& fit, const schema::Transducer& base,
                              const std::string& name);
/// Adds the hysteresis and the gain of the loops. The band is the base's, or ends at the loops' frequency.
schema::Transducer identified(const LoopFit& fit, const schema::Transducer& base, const std::string& name,
                              const schema::Identification& about);
/// Combines the linear model of the sweep with the hysteresis of the loops; without hysteresis if the loops
/// have none.
schema::Transducer identified(const JointFit& fit, const schema::Transducer& base, const std::string& name);
/// Sets mass and damping from the ringing; stiffnesses and gains do not change.
schema::Transducer identified(const TapsFit& fit, const schema::Transducer& base, const std::string& name,
                              const schema::Identification& about);

}  // namespace tacto::analysis
