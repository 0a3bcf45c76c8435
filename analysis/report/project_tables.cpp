// SPDX-License-Identifier: GPL-3.0-or-later
// Files without samples: transducers, devices, hands, tables, calibrations, scenes and results.
#include <fmt/format.h>

#include <cmath>
#include <complex>

#include "analysis/identify/measure/angles.hpp"
#include "analysis/report/project_readers.hpp"
#include "data-schema/base/decibels.hpp"
#include "data-schema/base/quantity.hpp"
#include "data-schema/calibration/calibration.hpp"
#include "data-schema/corpus/corpus_plan.hpp"
#include "data-schema/experiment/protocol.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/mesh/mesh.hpp"
#include "data-schema/results/trade_table.hpp"
#include "data-schema/session/session_netcdf.hpp"
#include "data-schema/texture/description.hpp"
#include "data-schema/texture/formants.hpp"
#include "data-schema/transducer/transducer.hpp"
#include "data-schema/volume/volume.hpp"

namespace tacto::analysis {
namespace {

using schema::Dimension;
using schema::for_people;
using schema::Result;
using schema::ResultCurve;

// 10 Hz to 1 kHz, the band of the paper's identification.
ResultCurve response_curve(const std::string& name, bool phase,
                           const std::function<std::complex<double>(double)>& response) {
  ResultCurve curve{name, {}, {}, false};
  constexpr int kPoints = 200;
  std::vector<std::complex<double>> values;
  for (int i = 0; i <= kPoints; ++i) {
    curve.x.push_back(10 * std::pow(100, static_cast<double>(i) / kPoints));
    values.push_back(response(curve.x.back()));
  }
  if (phase) curve.y = carried_phase_deg(values);
  if (!phase)
    for (const auto& value : values) curve.y.push_back(schema::amplitude_db(std::abs(value)));
  return curve;
}

void add_bode(const schema::Transducer& transducer, ProjectFile& file) {
  constexpr double kMicrometres = 1e6;
  const auto actuator = [&](double f) { return kMicrometres * schema::actuator_response(transducer, f); };
  const auto sensor = [&](double f) { return schema::sensor_response(transducer, f); };
  file.pictures.push_back(
      {"Amplitude",
       "frequency (Hz)",
       "dB re 1 µm/V, 1 V/N",
       true,
       {response_curve("actuator", false, actuator), response_curve("sensor", false, sensor)}});
  file.pictures.push_back(
      {"Phase",
       "frequency (Hz)",
       "degrees",
       true,
       {response_curve("actuator", true, actuator), response_curve("sensor", true, sensor)}});
}

void add_identification(const schema::Identification& identification, ProjectFile& file) {
  file.date = identification.date;
  file.origin = identification.source;
  file.simulated = identification.simulated;
  const char* believed = identification.usable()    ? ""
                         : identification.converged ? ", misfit"
                                                    : ", not converged";
  file.figures.insert(file.figures.begin(),
                      {"identified", fmt::format("R² {:.5f}{}", identification.r_squared, believed)});
  file.figures.push_back(
      {"valid", fmt::format("{} to {}", for_people(identification.low_hz, Dimension::frequency),
                            for_people(identification.high_hz, Dimension::frequency))});
  file.figures.push_back({"conditions", identification.conditions});
  file.figures.push_back({"result of the fit", identification.words});
}

ResultCurve bands_curve(const schema::Description& description) {
  ResultCurve curve{description.texture, {}, {}, false};
  for (const schema::ThirdOctaveBand& band : description.bands) {
    curve.x.push_back(1e-3 * band.centre_per_m);
    curve.y.push_back(schema::amplitude_db(band.rms));
  }
  return curve;
}

}  // namespace

Result<void> add_transducer(const std::string& path, ProjectFile& file) {
  const auto transducer = schema::read_transducer(path);
  TACTO_TRY(transducer);
  file.origin = transducer->name;
  file.figures = {{"resonance", for_people(schema::resonance_hz(*transducer), Dimension::frequency)},
                  {"damping ratio", fmt::format("{:.3g}", schema::damping_ratio(*transducer))},
                  {"actuator at rest",
                   fmt::format("{:.3g} µm/V", 1e6 * std::abs(schema::actuator_response(*transducer, 0)))},
                  {"drive limit", for_people(transducer->drive_limit_v, Dimension::voltage)},
                  {"from", transducer->origin}};
  if (transducer->identification) add_identification(*transducer->identification, file);
  add_bode(*transducer, file);
  return {};
}

Result<void> add_formants(const std::string& path, ProjectFile& file) {
  const auto formants = schema::read_formants(path);
  TACTO_TRY(formants);
  file.date = formants->created;
  for (const schema::FormantTable& table : formants->tables) {
    if (!table.simulated.empty()) file.simulated = table.simulated;
    std::string value = fmt::format("{} formants", table.formants.size());
    if (!table.formants.empty())
      value += ", the strongest at " +
               for_people(table.formants.front().frequency_per_m, Dimension::spatial_frequency);
    file.figures.push_back({table.texture, value});
  }
  return {};
}

Result<void> add_descriptions(const std::string& path, ProjectFile& file) {
  const auto descriptions = schema::read_descriptions(path);
  TACTO_TRY(descriptions);
  file.date = descriptions->created;
  schema::ResultPicture picture{
      "One-third-octave bands", "spatial frequency (1/mm)", "RMS (dB re 1 unit)", true, {}};
  for (const schema::Description& each : descriptions->textures) {
    if (!each.simulated.empty()) file.simulated = each.simulated;
    file.figures.push_back(
        {each.texture, fmt::format("RMS {:.4g} {}, centroid {}", each.rms, each.unit,
                                   for_people(each.centroid_per_m, Dimension::spatial_frequency))});
    picture.curves.push_back(bands_curve(each));
  }
  if (!picture.curves.empty()) file.pictures.push_back(std::move(picture));
  return {};
}

Result<void> add_calibration(const std::string& path, ProjectFile& file) {
  const auto calibration = schema::read_calibration(path);
  TACTO_TRY(calibration);
  file.origin = calibration->serial;
  file.simulated = calibration->simulated;
  for (const schema::CalibrationEntry& entry : calibration->entries) {
    file.date = entry.date;
    std::string value = fmt::format("{}, {}", entry.method, entry.date);
    if (entry.scale) value += fmt::format(", {:.4g} of nominal", *entry.scale / entry.nominal_scale);
    file.figures.push_back({entry.channel, value});
  }
  return {};
}

Result<void> add_trade_table(const std::string& path, ProjectFile& file) {
  const auto table = schema::read_trade_table(path);
  TACTO_TRY(table);
  file.date = table->created;
  file.origin = table->machine;
  for (const schema::MeasuredChoice& choice : table->choices)
    file.figures.push_back(
        {choice.stage + ", " + choice.name, fmt::format("{:.3g} ns per {}", choice.cost_ns, choice.per)});
  return {};
}

Result<void> add_corpus_plan(const std::string& path, ProjectFile& file) {
  const auto plan = schema::read_corpus_plan(path);
  TACTO_TRY(plan);
  file.date = plan->created;
  file.figures = {{"recordings", fmt::format("{}", plan->recordings.size())}};
  for (const schema::CorpusStep& step : plan->steps)
    file.figures.push_back({step.step, step.options.empty() ? "no options" : step.options});
  return {};
}

Result<void> add_protocol(const std::string& path, ProjectFile& file) {
  const auto protocol = schema::read_protocol(path);
  TACTO_TRY(protocol);
  const bool two_interval = protocol->task == schema::Task::two_interval;
  file.figures = {
      {"question", question_of(*protocol)},
      {two_interval ? "levels" : "comparisons",
       fmt::format("{}, {} times each", two_interval ? protocol->levels.size() : protocol->comparisons.size(),
                   protocol->repetitions)}};
  return {};
}

Result<void> add_session_table(const std::string& path, ProjectFile& file) {
  const auto table = schema::read_session_table(path);
  TACTO_TRY(table);
  file.date = table->created;
  file.origin = table->device;
  file.simulated = table->simulated;
  file.figures = {
      {"played", for_people(table->duration_s, Dimension::time)},
      {"ticks", fmt::format("{} at {}", table->times, for_people(table->rate_hz, Dimension::frequency))},
      {"transducer", table->transducer}};
  for (const std::string& texture : table->textures) file.figures.push_back({"texture", texture});
  return {};
}

Result<void> add_height_map(const std::string& path, ProjectFile& file) {
  const auto map = schema::read_height_map(path);
  TACTO_TRY(map);
  file.date = map->created;
  file.origin = map->source;
  const schema::HeightFigures figures = figures_of(*map);
  file.figures = {
      {"heights", fmt::format("{} x {}, {} apart", map->columns, map->rows,
                              for_people(map->pitch_m, Dimension::length))},
      {"from lowest to highest", for_people(figures.highest_m - figures.lowest_m, Dimension::length)},
      {"RMS slope", fmt::format("{:.3g}", figures.rms_slope)}};
  return {};
}

Result<void> add_mesh(const std::string& path, ProjectFile& file) {
  const auto mesh = schema::read_mesh(path);
  TACTO_TRY(mesh);
  file.date = mesh->created;
  file.origin = mesh->source;
  const schema::MeshFigures figures = figures_of(*mesh);
  const auto size = [&](std::size_t i) {
    return for_people(figures.most_m[i] - figures.least_m[i], Dimension::length);
  };
  file.figures = {{"triangles", fmt::format("{}", mesh->triangles.size())},
                  {"size", fmt::format("{}, {}, {}", size(0), size(1), size(2))},
                  {"longest edge", for_people(figures.longest_edge_m, Dimension::length)}};
  return {};
}

Result<void> add_volume(const std::string& path, ProjectFile& file) {
  const auto volume = schema::read_volume(path);
  TACTO_TRY(volume);
  file.date = volume->created;
  file.origin = volume->source;
  const auto each = [](const schema::VolumePoint& lengths_m) {
    return fmt::format("{}, {}, {}", for_people(lengths_m[0], Dimension::length),
                       for_people(lengths_m[1], Dimension::length),
                       for_people(lengths_m[2], Dimension::length));
  };
  const auto [half_x, half_y, half_z] = volume->half_size_m();
  file.figures = {
      {"values", fmt::format("{} x {} x {}", volume->samples[0], volume->samples[1], volume->samples[2])},
      {"spacing", each(volume->spacing_m)},
      {"size", each({2 * half_x, 2 * half_y, 2 * half_z})}};
  return {};
}

Result<void> add_results(const std::string& path, ProjectFile& file) {
  auto results = schema::read_results(path);
  TACTO_TRY(results);
  file.date = results->created;
  file.origin = results->verb;
  for (const std::string& input : results->inputs) file.origin += " " + input;
  if (!results->device.empty()) file.origin += " on " + results->device;
  file.simulated = results->simulated;
  file.figures = std::move(results->figures);
  file.pictures = std::move(results->pictures);
  return {};
}

}  // namespace tacto::analysis
