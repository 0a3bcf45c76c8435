// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "capture/calibrate/reference_scale.hpp"
#include "capture/calibrate/released_weight.hpp"
#include "capture/calibrate/weights.hpp"
#include "capture/cli/calibrate_parts.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/report/report.hpp"
#include "firmware-host/open_device.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::Result;

struct CalibrateForceOptions {
  CalibrateOptions common;
  std::string channel = "normal_force", reference, from;
  std::vector<std::string> masses, releases;
  std::optional<double> time_s, gravity_mps2;
};

// "100g", "0.5N", "100g=oak@1s..3s"
struct Mass {
  double force_n = 0;
  std::string words, recording;
};

Result<Mass> parse_mass(const std::string& text, double gravity_mps2) {
  const auto equals = text.find('=');
  const std::string words = text.substr(0, equals);
  const std::string recording = equals == std::string::npos ? "" : text.substr(equals + 1);
  if (const auto force_n = schema::parse_quantity(words, Dimension::force))
    return Mass{*force_n, words, recording};
  const auto mass_kg = schema::parse_quantity(words, Dimension::mass);
  if (!mass_kg)
    return schema::fail(ErrorKind::usage, fmt::format("'{}' is neither a mass nor a force", words), "mass",
                        "for example 100g, 0.98N, or 100g=recording@1s..3s");
  return Mass{*mass_kg * gravity_mps2, words, recording};
}

Result<Take> take_for(const Mass& mass, const CalibrateForceOptions& options) {
  if (!mass.recording.empty()) {
    const auto part = parse_recording_part(mass.recording);
    return part ? take_from(*part) : schema::forward_error(part);
  }
  const auto ready = wait_for_enter(
      mass.force_n == 0 ? "Remove everything from " + options.channel
                        : fmt::format("Hang {} on {} and wait until it rests", mass.words, options.channel));
  TACTO_TRY(ready);
  const auto device = firmware_host::open_device(options.common.device);
  return device ? take_from(**device, options.time_s.value_or(3)) : schema::forward_error(device);
}

cli::Report row_of(const Mass& mass, const Weighing& weighing, const WeighedScale& found) {
  cli::Report row;
  row.add("mass", mass.words).add("force_n", mass.force_n);
  const double shown_n = (weighing.code.value - found.zero.value) * found.scale.value;
  row.add("residual_n", shown_n - mass.force_n);
  return row.add("noise_of_mean_n", std::abs(weighing.code.uncertainty * found.scale.value));
}

schema::CalibrationEntry entry_for(const schema::Channel& channel, const std::string& method,
                                   const Uncertain& scale, std::vector<std::string> notes) {
  schema::CalibrationEntry entry;
  entry.channel = channel.name;
  entry.unit = channel.unit;
  entry.method = method;
  entry.nominal_scale = channel.scale;
  entry.scale = scale.value;
  entry.scale_uncertainty = scale.uncertainty;
  entry.degrees_of_freedom = std::isfinite(scale.degrees_of_freedom) ? scale.degrees_of_freedom : 0;
  entry.notes = std::move(notes);
  return entry;
}

struct Weighed {
  std::optional<Take> last;
  std::vector<Mass> masses;
  std::vector<Weighing> weighings;
};

Result<Weighed> weigh(const CalibrateForceOptions& options, double gravity_mps2) {
  Weighed weighed;
  for (const std::string& text : options.masses) {
    auto mass = parse_mass(text, gravity_mps2);
    TACTO_TRY(mass);
    auto take = take_for(*mass, options);
    TACTO_TRY(take);
    if (weighed.last && weighed.last->header.serial != take->header.serial)
      return schema::fail(ErrorKind::unsuitable, "is from another device than the one before",
                          mass->recording);
    const auto weighing = weighing_of(*take, options.channel, mass->force_n);
    TACTO_TRY(weighing);
    weighed.weighings.push_back(*weighing);
    weighed.masses.push_back(std::move(*mass));
    weighed.last = std::move(*take);
  }
  return weighed;
}

double gravity_uncertainty(const CalibrateForceOptions& options, const std::vector<std::string>& weights) {
  const auto is_mass = [](const std::string& text) {
    return schema::parse_quantity(text.substr(0, text.find('=')), Dimension::mass).has_value();
  };
  const bool matters = !options.gravity_mps2 && std::ranges::any_of(weights, is_mass);
  return matters ? kGravityUncertainty_mps2 / schema::kStandardGravity_mps2 : 0;
}

Result<cli::Report> by_weights(const CalibrateForceOptions& options) {
  const double gravity_mps2 = options.gravity_mps2.value_or(schema::kStandardGravity_mps2);
  const auto weighed = weigh(options, gravity_mps2);
  TACTO_TRY(weighed);
  const auto found = scale_by_weights(weighed->weighings, gravity_uncertainty(options, options.masses));
  TACTO_TRY(found);
  const Take& take = *weighed->last;
  const schema::Channel& channel = take.header.channels[*schema::find_channel(take.header, options.channel)];
  cli::Report report = report_on(take);
  report.add("channel", channel.name);
  add_scale(report, found->scale, channel.scale, "N");
  report.add("offset_n", channel.physical(found->zero.value));
  std::vector<cli::Report> rows;
  for (std::size_t i = 0; i < weighed->masses.size(); ++i)
    rows.push_back(row_of(weighed->masses[i], weighed->weighings[i], *found));
  report.add("weights", std::move(rows)).add("notes", found->notes);
  auto entry = entry_for(channel, "weights", found->scale, found->notes);
  entry.zero = found->zero.value;
  entry.zero_uncertainty = found->zero.uncertainty;
  return kept(std::move(report), options.common, take, {entry});
}

Result<Take> pull_for(const CalibrateForceOptions& options) {
  if (!options.from.empty()) {
    const auto part = parse_recording_part(options.from);
    return part ? take_from(*part) : schema::forward_error(part);
  }
  const auto device = firmware_host::open_device(options.common.device);
  return device ? take_from(**device, options.time_s.value_or(10)) : schema::forward_error(device);
}

Result<Take> take_of_release(const Mass& mass, const CalibrateForceOptions& options) {
  if (mass.recording.empty())
    TACTO_TRY(wait_for_enter(
        fmt::format("Hang {} on a thread that pulls along +x (cut it within {:g} s after Enter)", mass.words,
                    options.time_s.value_or(10))));
  CalibrateForceOptions plain = options;
  plain.from = mass.recording;
  return pull_for(plain);
}

// The newest calibrated scale of the reference; otherwise its nominal scale, whose uncertainty is unknown.
Result<Uncertain> scale_of_reference(const CalibrateForceOptions& options, const Take& take) {
  const auto index = schema::find_channel(take.header, options.reference);
  if (!index)
    return schema::fail(ErrorKind::usage, index.error().what, index.error().where, index.error().remedy);
  const double own_scale = take.header.channels[*index].scale;
  const auto file = calibration_of(take.header.serial, options.common.calibration);
  const auto* entry = file && *file ? schema::newest_scale(**file, options.reference) : nullptr;
  if (entry != nullptr && std::abs(entry->nominal_scale / own_scale - 1) < 1e-9)
    return Uncertain{*entry->scale, entry->scale_uncertainty.value_or(0)};
  cli::warn(options.reference +
            " is not calibrated itself: its nominal scale is used, and the uncertainty does not include it");
  return Uncertain{own_scale, 0};
}

Result<cli::Report> by_reference(const CalibrateForceOptions& options) {
  const auto take = pull_for(options);
  TACTO_TRY(take);
  const auto reference = scale_of_reference(options, *take);
  TACTO_TRY(reference);
  const auto found = scale_by_reference(*take, options.channel, options.reference, *reference);
  TACTO_TRY(found);
  const schema::Channel& channel =
      take->header.channels[*schema::find_channel(take->header, options.channel)];
  cli::Report report = report_on(*take);
  report.add("channel", channel.name).add("reference", options.reference);
  add_scale(report, found->scale, channel.scale, "N");
  report.add("least_coherence", found->coherence).add("notes", found->notes);
  return kept(std::move(report), options.common, *take,
              {entry_for(channel, "reference " + options.reference, found->scale, found->notes)});
}

Result<cli::Report> by_releases(const CalibrateForceOptions& options) {
  std::vector<Release> releases;
  for (const std::string& text : options.releases) {
    const auto mass = parse_mass(text, options.gravity_mps2.value_or(schema::kStandardGravity_mps2));
    TACTO_TRY(mass);
    auto take = take_of_release(*mass, options);
    TACTO_TRY(take);
    releases.push_back({std::move(*take), mass->force_n});
  }
  const auto found =
      scale_by_releases(releases, options.channel, gravity_uncertainty(options, options.releases));
  TACTO_TRY(found);
  const Take& take = releases.back().take;
  const schema::Channel& channel = take.header.channels[*schema::find_channel(take.header, options.channel)];
  cli::Report report = report_on(take);
  report.add("channel", channel.name).add("releases", releases.size());
  add_scale(report, found->scale, channel.scale, "N");
  report.add("notes", found->notes);
  return kept(std::move(report), options.common, take,
              {entry_for(channel, "released weight", found->scale, found->notes)});
}

Result<cli::Report> run_calibrate_force(CalibrateForceOptions options) {
  const int ways = (options.masses.empty() ? 0 : 1) + (options.releases.empty() ? 0 : 1) +
                   (options.reference.empty() ? 0 : 1);
  if (ways != 1)
    return schema::fail(
        ErrorKind::usage, "needs either weights, or a reference, or releases", "force",
        "for example --mass 0g --mass 100g; for the piezo --reference net_force, or --release 10g");
  if (!options.masses.empty()) return by_weights(options);
  if (options.channel == "normal_force") options.channel = "tangential_force";
  return options.reference.empty() ? by_releases(options) : by_reference(options);
}

}  // namespace

cli::Action declare_force(CLI::App& app) {
  auto options = std::make_shared<CalibrateForceOptions>();
  declare_common(app, options->common);
  app.add_option("--mass", options->masses,
                 "A known weight, hung when requested: 0g, 100g, 0.5N; or of a recording: 100g=oak@1s..3s. "
                 "At least two");
  app.add_option("--channel", options->channel,
                 "Channel that is calibrated; with --reference and --release tangential_force");
  app.add_option("--reference", options->reference,
                 "For the piezo, which does not measure constant forces: channel of a load cell for the same "
                 "force while a finger slides");
  app.add_option("--release", options->releases,
                 "For the piezo without a load cell: a weight on a thread that is cut, 10g, or "
                 "10g=oak@1s..3s; several show the scatter");
  app.add_option("--from", options->from, "With --reference: a recording instead of the device");
  cli::add_quantity(app, "--time", options->time_s, Dimension::time,
                    "Duration of a measurement: 3s per weight, 10s per release or with a reference");
  cli::add_quantity(app, "--gravity", options->gravity_mps2, Dimension::acceleration,
                    fmt::format("Local gravity; default: {}m/s^2, with 0.15 % of uncertainty",
                                schema::kStandardGravity_mps2));
  return [options] { return run_calibrate_force(*options); };
}

}  // namespace tacto::capture
