// SPDX-License-Identifier: GPL-3.0-or-later
// What works and what does not between a user and a recording, in the order in which it is needed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capture/record/apply_calibration.hpp"
#include "data-schema/base/error.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::capture {

struct DoctorRequest {
  std::string device = "usb:";
  std::string folder = ".";  ///< where recordings are to go
  std::string calibration;   ///< the device's file; empty: where it is usually kept
  double stale_after_s = kStaleAfter_s;
  std::size_t questions = 200;  ///< of which the round trip is the median
  std::string root = "/";       ///< of /proc and /etc; another one in tests
};

enum class Health { works, warns, fails, skipped };

struct Check {
  std::string name;  ///< "device", "permission", "firmware", "round trip", "real time", "disk",
                     ///< "temporary files", "calibration"
  Health health = Health::works;
  std::string found;
  std::string remedy;                                   ///< what to do; empty where all is well
  schema::ErrorKind fault = schema::ErrorKind::device;  ///< of what fails
};

struct Diagnosis {
  std::vector<Check> checks;
  std::string next;  ///< what to type
  /// The first that stands in the way of a recording; nullptr where one can be made.
  const Check* obstacle() const;
};

/// What a device that is used must give; the checks that need one are skipped where there is none.
Diagnosis examine(const DoctorRequest& request);

/// The parts, each a check of its own. `bytes_per_s` is what the device's stream brings to the disk.
Check check_round_trip(firmware_host::Device& device, std::size_t questions);
Check check_real_time(const std::string& root);
Check check_disk(const std::string& folder, double bytes_per_s);
/// Removes the temporary files that killed runs left in the folder; warns of those whose run may go on
/// elsewhere.
Check check_temporary_files(const std::string& folder);
Check check_calibration(const firmware_host::Capabilities& capabilities, const DoctorRequest& request);
/// Whether a device is there that this user may not open.
bool is_denied(const schema::Error& why);
/// Of a device that could not be opened, and why.
Check check_permission(const schema::Error& why, const std::string& root);

}  // namespace tacto::capture
