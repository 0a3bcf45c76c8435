// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "capture/calibrate/travel.hpp"
#include "capture/cli/calibrate_parts.hpp"
#include "capture/record/watch_counts.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/report/terminal.hpp"
#include "firmware-host/open_device.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;
using schema::Result;

struct CalibrateEncoderOptions {
  CalibrateOptions common;
  double travel_m = 0, travel_uncertainty_m = 0;
  std::size_t repeats = 3;
  std::string channel = "position";
  std::vector<std::string> from;
};

struct Travels {
  std::optional<Take> last;
  std::vector<double> differences;
  double step = 1;
};

Result<Travels> of_recordings(const CalibrateEncoderOptions& options) {
  Travels travels;
  for (const std::string& text : options.from) {
    const auto part = parse_recording_part(text);
    TACTO_TRY(part);
    auto take = take_from(*part);
    TACTO_TRY(take);
    if (travels.last && travels.last->header.serial != take->header.serial)
      return schema::fail(schema::ErrorKind::unsuitable, "is from another device than the one before", text);
    const auto differences = count_differences(*take, options.channel);
    TACTO_TRY(differences);
    travels.differences.insert(travels.differences.end(), differences->begin(), differences->end());
    travels.step = std::max(1.0, step_of(take->codes[*schema::find_channel(take->header, options.channel)]));
    travels.last = std::move(*take);
  }
  return travels;
}

void ask_for_end(std::size_t ends) {
  cli::write_message(
      fmt::format("Move to the {} mark, then press Enter: ", ends % 2 == 0 ? "first" : "second"));
  std::fflush(stderr);
}

Result<Travels> of_device(const CalibrateEncoderOptions& options) {
  const auto device = firmware_host::open_device(options.common.device);
  TACTO_TRY(device);
  std::size_t ends = 0;
  ask_for_end(ends);
  const auto marked = [&] {
    const auto pressed = enter_was_pressed();
    if (pressed && *pressed && ++ends <= options.repeats) ask_for_end(ends);
    return pressed;
  };
  auto watched = watch_counts(**device, options.channel, options.repeats + 1, marked);
  TACTO_TRY(watched);
  Travels travels{std::move(watched->take), {}, 1};
  for (std::size_t i = 1; i < watched->counts.size(); ++i)
    travels.differences.push_back(travelled_counts(watched->counts[i - 1], watched->counts[i]));
  return travels;
}

Result<cli::Report> run_calibrate_encoder(const CalibrateEncoderOptions& options) {
  const auto travels = options.from.empty() ? of_device(options) : of_recordings(options);
  TACTO_TRY(travels);
  const auto found =
      scale_by_travel(travels->differences, options.travel_m, options.travel_uncertainty_m, travels->step);
  TACTO_TRY(found);
  const Take& take = *travels->last;
  const schema::Channel& channel = take.header.channels[*schema::find_channel(take.header, options.channel)];
  cli::Report report = report_on(take);
  report.add("channel", channel.name).add("travels", travels->differences.size());
  add_scale(report, found->scale, channel.scale, channel.unit);
  report.add("first_travel", found->direction > 0 ? "counts up" : "counts down").add("notes", found->notes);
  schema::CalibrationEntry entry;
  entry.channel = channel.name;
  entry.unit = channel.unit;
  entry.method = "travel";
  entry.nominal_scale = channel.scale;
  entry.scale = found->scale.value;
  entry.scale_uncertainty = found->scale.uncertainty;
  entry.degrees_of_freedom =
      std::isfinite(found->scale.degrees_of_freedom) ? found->scale.degrees_of_freedom : 0;
  entry.notes = found->notes;
  return kept(std::move(report), options.common, take, {entry});
}

}  // namespace

cli::Action declare_encoder(CLI::App& app) {
  auto options = std::make_shared<CalibrateEncoderOptions>();
  declare_common(app, options->common);
  cli::add_quantity(app, "--travel", options->travel_m, Dimension::length,
                    "Distance from one mark to the other")
      ->required();
  cli::add_quantity(app, "--travel-uncertainty", options->travel_uncertainty_m, Dimension::length,
                    "Standard uncertainty of that distance");
  app.add_option("--repeats", options->repeats, "Number of travels, alternately forth and back")
      ->check(cli::from_one());
  app.add_option("--channel", options->channel, "Channel of the encoder");
  app.add_option("--from", options->from,
                 "Recordings instead of the device: travels from mark to mark, or from beginning to end");
  return [options] { return run_calibrate_encoder(*options); };
}

}  // namespace tacto::capture
