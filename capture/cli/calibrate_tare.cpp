// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "capture/calibrate/tare.hpp"
#include "capture/cli/calibrate_parts.hpp"
#include "data-schema/report/report.hpp"
#include "firmware-host/open_device.hpp"

namespace tacto::capture {
namespace {

using schema::Result;

struct CalibrateTareOptions {
  CalibrateOptions common;
  std::string from;
  double time_s = 5;
};

std::string mains_words(const ChannelTare& tare, const std::string& unit) {
  if (tare.mains.empty()) return "none";
  std::string words;
  for (const MainsLine& line : tare.mains)
    words += fmt::format("{}{:g} Hz {:.2g} {} (+{:.0f} dB)", words.empty() ? "" : ", ", line.frequency_hz,
                         line.amplitude, unit, line.above_floor_db);
  return words;
}

cli::Report row_of(const ChannelTare& tare, const schema::Channel& channel) {
  cli::Report row;
  row.add("channel", channel.name).add("offset_n", tare.mean);
  row.add("offset_uncertainty_n", std::abs(tare.zero.uncertainty * channel.scale));
  row.add("noise_rms_n", tare.noise_rms).add("noise_density_n_per_sqrt_hz", tare.noise_density);
  return row.add("mains", mains_words(tare, channel.unit));
}

Result<Take> take_for(const CalibrateTareOptions& options) {
  if (!options.from.empty()) {
    const auto part = parse_recording_part(options.from);
    return part ? take_from(*part) : schema::forward_error(part);
  }
  const auto device = firmware_host::open_device(options.common.device);
  return device ? take_from(**device, options.time_s) : schema::forward_error(device);
}

Result<void> check_still(const Tare& tare, bool anyway) {
  if (tare.motion_signs.empty()) return {};
  const std::string what = fmt::format("the device was not at rest: {}", fmt::join(tare.motion_signs, "; "));
  if (!anyway)
    return schema::fail(schema::ErrorKind::unsuitable, what, "tare",
                        "remove the finger and wait, or use --anyway");
  cli::warn(what);
  return {};
}

Result<cli::Report> run_calibrate_tare(const CalibrateTareOptions& options) {
  const auto take = take_for(options);
  TACTO_TRY(take);
  const auto tare = tare_of(*take);
  TACTO_TRY(tare);
  TACTO_TRY(check_still(*tare, options.common.anyway));
  for (const std::string& warning : tare->warnings) cli::warn(warning);
  cli::Report report = report_on(*take);
  std::vector<cli::Report> rows;
  for (const ChannelTare& one : tare->channels)
    rows.push_back(row_of(one, take->header.channels[one.channel]));
  report.add("channels", std::move(rows));
  return kept(std::move(report), options.common, *take, entries_of(*tare, *take));
}

}  // namespace

cli::Action declare_tare(CLI::App& app) {
  auto options = std::make_shared<CalibrateTareOptions>();
  declare_common(app, options->common);
  app.add_option("--from", options->from, "A recording instead of the device: oak, or oak@1s..3s");
  cli::add_quantity(app, "--time", options->time_s, schema::Dimension::time, "Duration of the measurement");
  return [options] { return run_calibrate_tare(*options); };
}

}  // namespace tacto::capture
