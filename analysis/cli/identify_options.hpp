// SPDX-License-Identifier: GPL-3.0-or-later
// The options of `identify`, and what its methods share.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "analysis/identify/measure/measured_tables.hpp"
#include "analysis/identify/report/identification.hpp"
#include "data-schema/files/files.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/results/results.hpp"
#include "playback/player/player_device.hpp"
#include "spatial/picture/figure.hpp"

namespace tacto::analysis {

struct IdentifyOptions {
  std::string file, device_uri, stem, base, picture, results;
  IdentifyMethod method = IdentifyMethod::joint;
  ModelChoice model;
  TableUnits units;
  ExcitationPlan plan;
  std::optional<double> amplitude_v, rate_hz;
  std::string input = "drive", output = "displacement";
  int phase_sign = 1;
  std::size_t taps_fitted = 0;
  bool invert = false, implausible = false;
  schema::Existing existing = schema::Existing::keep;
  std::optional<double> high_hz;  ///< --high, if it was given
};

/// The source of a measurement: a device or a file.
struct IdentifySource {
  playback::PlayerDevice device;
  schema::Transducer base;
  bool stopped = false;  ///< by a signal, during the measurement
  bool has_device() const { return device.device != nullptr; }
};

/// The plan at the device's rate. Its peak is the requested one, by default `usual_v`; its highest frequency,
/// if none was requested, at most the device's rate allows.
ExcitationPlan plan_on(const IdentifyOptions& options, const firmware_host::Device& device, double usual_v);
std::string transducer_name_of(const IdentifyOptions& options);
std::string transducer_file_of(const IdentifyOptions& options);
/// Draws a picture if one was requested. Errors: those of write_figure.
schema::Result<void> draw_identified(const IdentifyOptions& options, const spatial::Figure& figure,
                                     cli::Report& report);
/// Writes results if they were requested; their details are the unchanged report.
schema::Result<cli::Report> with_identify_results(const IdentifyOptions& options,
                                                  const std::function<schema::Results()>& make,
                                                  cli::Report report);
/// `--method contact`: describes taps and writes no file.
schema::Result<cli::Report> identify_contact(const IdentifyOptions& options);
/// Checks a response before and after its fit (plausibility.hpp).
schema::Result<void> check_fitted(const IdentifyOptions& options, const ResponseFit& fit,
                                  const schema::Transducer& base);

}  // namespace tacto::analysis
