// SPDX-License-Identifier: GPL-3.0-or-later
// From what was found to the transducer's file.
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

enum class IdentifyMethod { sweep, multisine, chirp, loop, taps, joint };

/// A response, and the drive that it was measured by.
struct DrivenResponse {
  BodeData data;
  SweptDrive drive;
};

/// Measures the actuator's response on a device by sweep, multisine or chirp. Errors: as drive_tray();
/// unsuitable: an amplitude that the base says would pass its limits.
schema::Result<DrivenResponse> driven_response(firmware_host::Device& device, IdentifyMethod method,
                                               const ExcitationPlan& plan, const schema::Transducer& base,
                                               const std::function<bool()>& stop_asked,
                                               const std::function<void(double)>& progress);
/// The response alone.
schema::Result<BodeData> measured_on(firmware_host::Device& device, IdentifyMethod method,
                                     const ExcitationPlan& plan, const schema::Transducer& base,
                                     const std::function<bool()>& stop_asked,
                                     const std::function<void(double)>& progress);

/// The drive that loops are made with where nobody says another: as far as the limits of drive and
/// displacement go.
double loop_amplitude_v(const schema::Transducer& base);
/// The peak of a sweep that goes with such loops: a fifth of theirs, or nine tenths of what the limits of
/// slew and displacement leave it in the plan's band.
double joint_amplitude_v(const ExcitationPlan& plan, const schema::Transducer& base);

/// The base with what was found in it, under a name of its own, dated, with validity and what the fit says of
/// itself. Where the base's linear model is kept (a finger, loops, taps) so is what its own identification
/// says against it.
schema::Transducer identified(const ResponseFit& fit, const schema::Transducer& base,
                              const std::string& name);
/// With the hysteresis, and the gain of the loops. The band is the base's, or up to the loops' frequency.
schema::Transducer identified(const LoopFit& fit, const schema::Transducer& base, const std::string& name,
                              const schema::Identification& about);
/// With the linear model of the one and the hysteresis of the other; without any where the loops show none.
schema::Transducer identified(const JointFit& fit, const schema::Transducer& base, const std::string& name);
/// With mass and damping from the ringing; stiffnesses and gains are held.
schema::Transducer identified(const TapsFit& fit, const schema::Transducer& base, const std::string& name,
                              const schema::Identification& about);

}  // namespace tacto::analysis
