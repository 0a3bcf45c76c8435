// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/record/apply_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "data-schema/files/files.hpp"

namespace tacto::capture {
namespace {

using schema::CalibrationEntry;
using schema::CalibrationFile;
using schema::Channel;
using schema::ErrorKind;
using schema::Result;

// Scales are written with all their digits, so equal scales differ only by rounding.
bool same(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::abs(b);
}

std::string day_of(const std::string& date) {
  return date.substr(0, 10);
}

struct Found {
  const CalibrationEntry *scale, *zero;
};

// An entry that was made with another nominal scale does not apply to the codes of today.
const CalibrationEntry* usable(const CalibrationEntry* entry, const Channel& channel,
                               std::vector<std::string>& warnings) {
  if (entry == nullptr || same(entry->nominal_scale, channel.scale)) return entry;
  warnings.push_back(fmt::format(
      "the calibration of {} is not applied: its nominal scale differs from that at the calibration ({}, {})",
      channel.name, entry->method, day_of(entry->date)));
  return nullptr;
}

void warn_of_date(const CalibrationEntry* entry, double stale_after_s, const std::string& now,
                  std::vector<std::string>& warnings) {
  if (entry == nullptr) return;
  const auto age_s = schema::seconds_between(entry->date, now);
  if (age_s && *age_s < -kClockSlack_s)
    warnings.push_back(
        fmt::format("the calibration of {} is dated in the future ({}, {}, {:.0f} days ahead): one clock is "
                    "wrong; newer calibrations are ignored until then",
                    entry->channel, entry->method, day_of(entry->date), -*age_s / 86400));
  if (age_s && *age_s <= stale_after_s) return;
  warnings.push_back(fmt::format("the calibration of {} is stale ({}, {}, {:.0f} days old)", entry->channel,
                                 entry->method, day_of(entry->date), age_s.value_or(0) / 86400));
}

void note_scale(Channel& channel, const CalibrationEntry& entry) {
  channel.calibration->scale_date = entry.date;
  channel.calibration->scale_method = entry.method;
  channel.calibration->scale_uncertainty = entry.scale_uncertainty;
  channel.scale = *entry.scale;
  if (!channel.derivation.empty())
    channel.derivation += fmt::format("; x {:.6g} by its calibration ({}, {})",
                                      *entry.scale / entry.nominal_scale, entry.method, day_of(entry.date));
}

void note_zero(Channel& channel, const CalibrationEntry& entry) {
  channel.calibration->zero_date = entry.date;
  if (entry.zero_uncertainty)
    channel.calibration->zero_uncertainty = std::abs(*entry.zero_uncertainty * channel.scale);
}

void calibrate(Channel& channel, const Found& found) {
  const double own_scale = channel.scale, own_offset = channel.offset;
  channel.calibration.emplace();
  channel.calibration->nominal_scale = own_scale;
  channel.calibration->nominal_offset = own_offset;
  if (found.scale) note_scale(channel, *found.scale);
  if (found.zero) note_zero(channel, *found.zero);
  channel.offset = found.zero ? -*found.zero->zero * channel.scale : own_offset / own_scale * channel.scale;
  channel.calibrated = day_of(found.scale ? found.scale->date : found.zero->date);
  const auto again = [&](double value) { return channel.physical((value - own_offset) / own_scale); };
  if (channel.range_min) channel.range_min = again(*channel.range_min);
  if (channel.range_max) channel.range_max = again(*channel.range_max);
}

Result<void> check_serial(const CalibrationFile& file, const std::string& serial) {
  if (file.serial == serial) return {};
  return schema::fail(
      ErrorKind::unsuitable,
      fmt::format("is the calibration of the device '{}', but this device is '{}'", file.serial, serial),
      "calibration", "give the file of this device with --calibration FILE");
}

}  // namespace

Result<std::vector<std::string>> apply_calibration(schema::RecordingHeader& header,
                                                   const CalibrationFile& file, double stale_after_s,
                                                   const std::string& now) {
  TACTO_TRY(check_serial(file, header.serial));
  std::vector<std::string> warnings;
  for (Channel& channel : header.channels) {
    if (channel.calibration) continue;
    const Found found{usable(schema::newest_scale(file, channel.name), channel, warnings),
                      usable(schema::newest_zero(file, channel.name), channel, warnings)};
    warn_of_date(found.scale, stale_after_s, now, warnings);
    if (found.zero != found.scale) warn_of_date(found.zero, stale_after_s, now, warnings);
    if (found.scale || found.zero) calibrate(channel, found);
  }
  return warnings;
}

Result<std::optional<CalibrationFile>> calibration_of(const std::string& serial, const std::string& path) {
  std::string place = path;
  if (place.empty()) {
    auto usual = schema::calibration_path(serial);
    if (!usual || !schema::is_file(*usual)) return std::nullopt;
    place = std::move(*usual);
  }
  auto file = schema::read_calibration(place);
  TACTO_TRY(file);
  return std::optional(std::move(*file));
}

Result<std::string> keep_calibration(const schema::RecordingHeader& device, const std::string& name,
                                     std::vector<CalibrationEntry> entries, const std::string& path,
                                     const std::string& now) {
  const auto place = path.empty() ? schema::calibration_path(device.serial) : Result<std::string>(path);
  if (!place) return place;
  const auto alone = schema::lock_calibration(*place);
  TACTO_TRY(alone);
  CalibrationFile file;
  if (schema::is_file(*place)) {
    auto before = schema::read_calibration(*place);
    TACTO_TRY(before);
    file = std::move(*before);
  } else {
    file.serial = device.serial;
  }
  TACTO_TRY(check_serial(file, device.serial));
  if (!name.empty()) file.device = name;
  file.simulated = device.simulated;
  for (CalibrationEntry& entry : entries) {
    entry.date = now;
    file.entries.push_back(std::move(entry));
  }
  TACTO_TRY(schema::write_calibration(*place, file));
  return *place;
}

}  // namespace tacto::capture
