// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of all that a recording needs, in the order in which it is needed.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capture/record/apply_calibration.hpp"
#include "data-schema/base/error.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::capture {

struct DiskSpeed {
  double free_bytes = 0;
  double write_bytes_per_s = 0;                ///< of 16 MB, written and synced
  double sync_median_s = 0, sync_worst_s = 0;  ///< of 20 blocks, synced as in a recording
};

/// Writes to an unnamed file, which is gone when this function returns or the process ends. `block_bytes` is
/// the amount that a recording syncs at once. Duration: that of the disk, about 0.1 s. Errors: cannot_write:
/// the folder does not exist or is not writable, or the disk is full.
schema::Result<DiskSpeed> measure_disk(const std::string& folder, std::size_t block_bytes);

struct RealtimeLimits {
  unsigned long priority = 0;  ///< RLIMIT_RTPRIO: the highest priority that may be requested, 0 for none
  bool granted = false;        ///< a thread requested SCHED_FIFO and received it
  std::optional<double> locked_bytes;  ///< RLIMIT_MEMLOCK; none: without limit
  /// The fraction of each second in which real-time threads may run, from sched_rt_runtime_us and _period_us;
  /// 1 without a throttle, none if the kernel does not provide it.
  std::optional<double> runtime;
};

/// `root` is the folder of /proc; only tests use another one than "/".
RealtimeLimits realtime_limits(const std::string& root = "/");

/// The one line of firmware-host/usb/60-tactograph.rules that is not a comment (a test compares them).
inline constexpr std::string_view kUdevRule =
    R"(SUBSYSTEM=="usb", ENV{DEVTYPE}=="usb_device", ENV{ID_USB_INTERFACES}=="*:ff54??:*", GROUP="plugdev", MODE="0660", TAG+="uaccess")";

struct DoctorRequest {
  std::string device = "usb:";
  std::string folder = ".";  ///< the folder for recordings
  std::string calibration;   ///< the calibration file of the device; empty: the default path
  double stale_after_s = kStaleAfter_s;
  std::size_t questions = 200;  ///< heartbeats; the round trip is their median
  std::string root = "/";       ///< the root of /proc and /etc; another one in tests
};

enum class Health { works, warns, fails, skipped };

struct Check {
  std::string name;  ///< "device", "permission", "firmware", "round trip", "real time", "disk",
                     ///< "temporary files", "calibration"; of a data acquisition card also "playing"
  Health health = Health::works;
  std::string found;
  std::string remedy;  ///< the instruction to the user; empty if nothing is wrong
  schema::ErrorKind fault = schema::ErrorKind::device;  ///< the kind of error, if the check fails
};

struct Diagnosis {
  std::vector<Check> checks;
  std::vector<schema::Channel> channels;  ///< of the device; empty without one
  std::string next;                       ///< the next command to type
  /// The first failed check that prevents a recording; nullptr if a recording can be made.
  const Check* first_failure() const;
};

/// Runs all checks; those that need a device are skipped if there is none.
Diagnosis examine(const DoctorRequest& request);

/// The parts, one check each. `bytes_per_s` is the data rate of the device's stream.
/// Warns of a firmware whose minor version of the protocol is older than the host's; an older major version
/// is refused when the device is opened.
Check check_firmware(const firmware_host::Capabilities& said, unsigned device_minor, unsigned host_minor);
Check check_round_trip(firmware_host::Device& device, std::size_t questions);
Check check_real_time(const std::string& root);
Check check_disk(const std::string& folder, double bytes_per_s);
/// Removes the temporary files of killed runs from the folder; warns of files whose run may still be active
/// on another machine.
Check check_temporary_files(const std::string& folder);
/// Whether a data acquisition card can also play, and up to which rate. It is opened to play: its output is
/// set to 0 V. Does not fail, as a recording needs none of it.
Check check_playing(const std::string& uri);
Check check_calibration(const firmware_host::Capabilities& capabilities, const DoctorRequest& request);
/// Whether the error says that a device is present that this user has no permission to open.
bool is_denied(const schema::Error& why);
/// The check of the permission to open a device, after opening failed with `why`.
Check check_permission(const schema::Error& why, const std::string& root);

}  // namespace tacto::capture
