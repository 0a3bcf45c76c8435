// SPDX-License-Identifier: GPL-3.0-or-later
// The checks of `doctor`, one function each.
#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <vector>

#include "capture/doctor/doctor.hpp"
#include "data-schema/base/creation_time.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/base/statistics.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/files/leftover_files.hpp"
#include "data-schema/recording/live_recording.hpp"
#include "firmware-host/core/wire/frame.hpp"
#include "firmware-host/link/client.hpp"
#include "firmware-host/open_device.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;
using schema::for_people;

constexpr double kSlowAnswer_s = 5e-3;  // our choice: in playback a heartbeat is due every 50 ms
constexpr double kSlowSync_s = schema::kMostLost_s - schema::kSyncEvery_s;  // a slower disk may lose more
constexpr double kLeastRoom_s = 10, kGoodRoom_s = 600, kGoodSpeed = 4;
constexpr double kLeastLocked_bytes = 64 << 20;
constexpr double kLargestBlock_bytes = 16 << 20;
constexpr const char* kRule = "60-tactograph.rules";

// A real device is at rest when its user removes the finger. An emulated one needs an option for it.
std::string tare_command(const std::string& device) {
  constexpr std::string_view kSim = "sim:";
  std::string at_rest = device;
  if (device.starts_with(kSim)) {
    std::string kept;
    for (std::size_t at = kSim.size(), end = 0; at < device.size(); at = end + 1) {
      end = std::min(device.find(',', at), device.size());
      const std::string key = device.substr(at, end - at);
      if (!key.starts_with("finger=") && !key.starts_with("strokes=") && !key.starts_with("force"))
        kept += key + ",";
    }
    at_rest = fmt::format("sim:{}finger=up,strokes=0", kept);
  }
  return "tactograph calibrate tare -d " + at_rest;
}

Check judged(std::string name, std::string found, const std::string& warning) {
  return {std::move(name), warning.empty() ? Health::works : Health::warns, std::move(found), warning};
}

std::string installed_rule(const std::string& root) {
  for (const char* folder : {"etc/udev/rules.d/", "usr/local/lib/udev/rules.d/", "usr/lib/udev/rules.d/",
                             "lib/udev/rules.d/", "run/udev/rules.d/"})
    if (schema::is_file(root + folder + kRule)) return root + folder + kRule;
  return {};
}

std::string advice_on(const RealtimeLimits& limits) {
  if (!limits.granted)
    return "playback without it may be late: put '@audio - rtprio 80' and '@audio - memlock unlimited' into "
           "/etc/security/limits.d/tactograph.conf, join the group audio, and log in again";
  if (limits.locked_bytes && *limits.locked_bytes < kLeastLocked_bytes)
    return "playback locks its memory: put '@audio - memlock unlimited' into "
           "/etc/security/limits.d/tactograph.conf";
  if (limits.runtime && *limits.runtime < 0.9)
    return "the kernel limits the time of real-time threads: sysctl kernel.sched_rt_runtime_us=950000";
  return {};
}

std::string words_of(const RealtimeLimits& limits) {
  return fmt::format(
      "{}; {} of memory can be locked; real-time threads can run {} of the time",
      limits.granted ? "priority granted" : fmt::format("no priority granted (limit {})", limits.priority),
      limits.locked_bytes ? fmt::format("{:.3g} MB", *limits.locked_bytes / 1e6) : "all",
      limits.runtime ? fmt::format("{:.0f} %", 100 * *limits.runtime) : "an unknown part");
}

std::string words_of(const DiskSpeed& disk, double bytes_per_s) {
  return fmt::format(
      "{:.0f} MB/s ({:.3g} MB/s needed), synchronised in {} (maximum {}), {:.3g} GB free for {}",
      disk.write_bytes_per_s / 1e6, bytes_per_s / 1e6, for_people(disk.sync_median_s, Dimension::time),
      for_people(disk.sync_worst_s, Dimension::time), disk.free_bytes / 1e9,
      disk.free_bytes / bytes_per_s > 5400 ? fmt::format("{:.0f} h", disk.free_bytes / bytes_per_s / 3600)
                                           : fmt::format("{:.0f} s", disk.free_bytes / bytes_per_s));
}

std::string advice_on(const DiskSpeed& disk, double bytes_per_s) {
  if (disk.free_bytes < kGoodRoom_s * bytes_per_s) return "the disk has little space: less than 10 min";
  if (disk.write_bytes_per_s < kGoodSpeed * bytes_per_s)
    return "the disk is hardly fast enough: use another disk";
  if (disk.sync_median_s > kSlowSync_s)
    return fmt::format("the disk synchronises slowly: after a power cut more than {} may be missing",
                       for_people(schema::kMostLost_s, Dimension::time));
  return {};
}

// "3 files, 1.2 MB".
std::string size_in_words(const std::vector<schema::Leftover>& files) {
  double bytes = 0;
  for (const schema::Leftover& file : files) bytes += static_cast<double>(file.bytes);
  return fmt::format("{} file{}, {:.3g} MB", files.size(), files.size() == 1 ? "" : "s", bytes / 1e6);
}

// The newest entries with a scale and a zero of the channel; one entry if both are in the same.
std::vector<const schema::CalibrationEntry*> newest_of(const schema::CalibrationFile& file,
                                                       const std::string& channel) {
  const auto* const scale = schema::newest_scale(file, channel);
  const auto* const zero = schema::newest_zero(file, channel);
  std::vector<const schema::CalibrationEntry*> entries;
  if (scale != nullptr) entries.push_back(scale);
  if (zero != nullptr && zero != scale) entries.push_back(zero);
  return entries;
}

}  // namespace

bool is_denied(const schema::Error& why) {
  return why.what.find("may not open") != std::string::npos || why.remedy.find(kRule) != std::string::npos;
}

Check check_permission(const schema::Error& why, const std::string& root) {
  const bool on_usb = !why.where.starts_with("tty:") && !why.where.starts_with("/dev/");
  if (!on_usb && is_denied(why))
    return {"permission", Health::fails, why.what, why.remedy, schema::ErrorKind::not_found};
  if (!on_usb) return {"permission", Health::skipped, "requires a device", {}};
  const std::string rule = installed_rule(root);
  const std::string found = rule.empty() ? fmt::format("{} is not installed", kRule) : rule + " is installed";
  const std::string remedy =
      rule.empty()
          ? fmt::format(
                "echo '{}' | sudo tee /etc/udev/rules.d/{} && sudo udevadm control "
                "--reload && sudo udevadm trigger, then plug the device in again",
                kUdevRule, kRule)
          : "join the group plugdev, or log in at the computer itself; then plug the device in again";
  if (is_denied(why)) return {"permission", Health::fails, found, remedy, schema::ErrorKind::not_found};
  return rule.empty() ? judged("permission", found, remedy) : judged("permission", found, {});
}

Check check_firmware(const firmware_host::Capabilities& said, unsigned device_minor, unsigned host_minor) {
  std::string found =
      fmt::format("{}, {:g} Hz, {} channels", said.firmware.empty() ? "no version" : said.firmware,
                  said.sample_rate_hz, said.channels.size());
  if (device_minor >= host_minor) return judged("firmware", std::move(found), {});
  return judged("firmware",
                fmt::format("{}; older than this program: protocol {}.{}, here {}.{}", found,
                            wire::kProtocolMajor, device_minor, wire::kProtocolMajor, host_minor),
                "make the firmware again with ./bootstrap firmware and flash it "
                "(firmware-host/boards/README.md)");
}

Check check_round_trip(firmware_host::Device& device, std::size_t questions) {
  std::vector<double> times_s;
  for (std::size_t i = 0; i < questions; ++i) {
    const auto time_s = device.round_trip_s();
    if (!time_s && time_s.error().kind == schema::ErrorKind::unsuitable)
      return {"round trip", Health::skipped, time_s.error().what, {}};
    if (!time_s) return {"round trip", Health::fails, time_s.error().what, time_s.error().remedy};
    times_s.push_back(*time_s);
  }
  if (times_s.empty()) return {"round trip", Health::skipped, "not measured", {}};
  const double median_s = schema::upper_median(std::span(times_s));
  std::ranges::sort(times_s);
  const double late_s = times_s[times_s.size() * 99 / 100];
  return judged("round trip",
                fmt::format("median {}, 99 of 100 within {}", for_people(median_s, Dimension::time),
                            for_people(late_s, Dimension::time)),
                late_s > kSlowAnswer_s ? "answers are slow: use fewer hubs or another port" : "");
}

Check check_real_time(const std::string& root) {
  const RealtimeLimits limits = realtime_limits(root);
  return judged("real time", words_of(limits), advice_on(limits));
}

Check check_disk(const std::string& folder, double bytes_per_s) {
  const double block_bytes = std::min(bytes_per_s * schema::kSyncEvery_s, kLargestBlock_bytes);
  const auto disk = measure_disk(folder, static_cast<std::size_t>(block_bytes));
  if (!disk)
    return {"disk", Health::fails, schema::message({disk.error().kind, disk.error().what, folder, {}}),
            disk.error().remedy, disk.error().kind};
  const std::string found = words_of(*disk, bytes_per_s);
  if (disk->free_bytes < kLeastRoom_s * bytes_per_s || disk->write_bytes_per_s < bytes_per_s)
    return {"disk", Health::fails, found, "record to another disk", schema::ErrorKind::cannot_write};
  return judged("disk", found, advice_on(*disk, bytes_per_s));
}

Check check_temporary_files(const std::string& folder) {
  const auto removed = schema::remove_ended(schema::leftovers_in(folder));
  const auto kept = schema::leftovers_in(folder);
  std::string found = removed.empty() ? "" : fmt::format("removed {} of killed runs", size_in_words(removed));
  if (kept.empty()) return judged("temporary files", found.empty() ? "none" : found, {});
  found += fmt::format("{}{} of runs that may still be active, here or on another machine, the first {}",
                       found.empty() ? "" : "; ", size_in_words(kept), kept.front().path);
  return judged("temporary files", found, "if no such run is active, remove them: rm " + kept.front().path);
}

Check check_playing(const std::string& uri) {
  auto device = firmware_host::open_device_to_play(uri);
  std::string lacking, remedy;
  if (!device &&
      device.error().kind == schema::ErrorKind::unsuitable) {  // perhaps only a watchdog is missing
    lacking = "; " + device.error().what, remedy = device.error().remedy;
    device = firmware_host::open_device_to_play(uri, true);
  }
  if (!device && device.error().kind == schema::ErrorKind::unsuitable)
    return {"playing", Health::skipped, device.error().what, device.error().remedy};
  if (!device) return {"playing", Health::warns, schema::message(device.error()), device.error().remedy};
  const wire::Welcome& about = (*device)->conversation()->description().welcome;
  return judged("playing",
                fmt::format("{:g} to {:g} ticks per second{}", 1e-3 * about.least_rate_millihertz,
                            1e-3 * about.most_rate_millihertz, lacking),
                remedy);
}

Check check_calibration(const firmware_host::Capabilities& said, const DoctorRequest& request) {
  const std::string tare = tare_command(request.device);
  const auto file = calibration_of(said.serial, request.calibration);
  if (!file)
    return {"calibration", Health::fails, schema::message(file.error()),
            "use another file, or record with --no-calibration", file.error().kind};
  if (!*file) return judged("calibration", "no calibration was found", tare);
  if ((**file).serial != said.serial)
    return {"calibration", Health::fails, "is the calibration of the device " + (**file).serial,
            "use the file of this device", schema::ErrorKind::unsuitable};
  std::vector<std::string> parts, stale, ahead;
  for (const schema::Channel& channel : said.channels)
    for (const auto* entry : newest_of(**file, channel.name)) {
      const auto age_s = schema::seconds_between(entry->date, schema::creation_time());
      parts.push_back(fmt::format("{} {} {}", channel.name, entry->method, entry->date.substr(0, 10)));
      if (!age_s || *age_s > request.stale_after_s) stale.push_back(channel.name);
      if (age_s && *age_s < -kClockSlack_s) ahead.push_back(channel.name);
    }
  if (parts.empty()) return judged("calibration", "contains no entry for these channels", tare);
  const std::string found = fmt::format("{}", fmt::join(parts, ", "));
  if (!ahead.empty())
    return judged(
        "calibration", fmt::format("dated in the future: {}; {}", fmt::join(ahead, ", "), found),
        "one clock is wrong: set the clock of this computer, or remove the file and calibrate again");
  return stale.empty()
             ? judged("calibration", found, {})
             : judged("calibration", fmt::format("stale: {}; {}", fmt::join(stale, ", "), found), tare);
}

}  // namespace tacto::capture
