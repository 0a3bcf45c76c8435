// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <utility>

#include "capture/cli/verbs.hpp"
#include "capture/import/height_map_import.hpp"
#include "capture/import/height_profile.hpp"
#include "capture/import/import_plan.hpp"
#include "capture/import/mesh_import.hpp"
#include "capture/import/volume_import.hpp"
#include "data-schema/cli/describe.hpp"
#include "data-schema/height/height_map.hpp"
#include "data-schema/report/progress.hpp"
#include "data-schema/report/report.hpp"
#include "data-schema/report/terminal.hpp"
#include "data-schema/report/warnings.hpp"

namespace tacto::capture {
namespace {

using schema::Dimension;

double parsed_percent(const std::string& text) {
  double percent = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, percent);
  if (error != std::errc() || std::string_view(stop, end) != "%" || !std::isfinite(percent))
    throw CLI::ValidationError("--humidity", fmt::format("'{}' is not a percentage; write it as 45%", text));
  return percent;
}

void declare_data(CLI::App& app, ImportRequest& request) {
  app.add_option("FILE", request.file,
                 "CSV table, MATLAB file (version 5 or 7.3) or XDF file of the Lab Streaming Layer (both: "
                 "without other options lists what it has), sound "
                 "file that libsndfile reads (WAV, FLAC, OGG ...), a measured profile "
                 "(XML, X3P), a height "
                 "map (greyscale PNG with 16 bits), a triangle mesh (STL, OBJ, PLY), or a volume (NRRD)")
      ->required();
  app.add_option("-o,--output", request.name,
                 "Name of the recording: NAME.wav and NAME.json; of a height map: NAME.height.nc, also from "
                 "a profile or a whole X3P surface if "
                 "written in full; of a mesh: NAME.mesh.nc; of a volume: NAME.volume.nc");
  app.add_option("--channel", request.channels,
                 "A channel, QUANTITY=COLUMN*SCALE+OFFSET and a unit (default: that of the column); repeat "
                 "for each. COLUMN: header name or number from 1, of a MATLAB file data.force or 'acc(:,2)'; "
                 "LABEL:QUANTITY for a second channel of a "
                 "quantity. Mono audio needs none: it is a signal")
      ->allow_extra_args(false);
  app.add_option("--skip", request.skip_lines,
                 "Number of lines before the header or first row of a table, if they are not detected")
      ->default_str("");
  cli::add_quantity(app, "--rate", request.rate_hz, Dimension::frequency,
                    "Samples per second of a table, or of audio with a wrong header");
  app.add_option("--time-column", request.time_column,
                 "Compute the rate from a column of times, COLUMN*SCALE and a unit: t_ms*1ms");
  app.add_option("--stream", request.stream,
                 "Of an XDF file: the name or number of the stream, if it has several of numbers");
  cli::add_quantity(
      app, "--pitch", request.pitch_m, Dimension::length,
      "Distance between heights: makes a texture (so do a height and a position without a rate), or with a "
      "PNG a height map");
  auto* const row = app.add_option("--row", request.row, "Of an X3P surface: the row to take, from 1");
  app.add_option("--column", request.column, "Of an X3P surface: the column to take, from 1")->excludes(row);
  app.add_option("--points", request.points,
                 "Of a line of an X3P file: only these points, FIRST..LAST from 1, as 121..480");
  cli::add_quantity(app, "--height", request.full_height_m, Dimension::length,
                    "Of a PNG: height of white; black is 0");
  app.add_flag("--allow-8bit", request.allow_8bit,
               "Accept a PNG with fewer than 16 bits: its levels are steps");
  app.add_option_function<std::string>(
         "--unit",
         [&request](const std::string& text) {
           const auto unit = schema::parse_quantity("1" + text, Dimension::length);
           if (!unit) throw CLI::ValidationError("--unit", schema::message(unit.error()));
           request.unit_m = *unit;
         },
         "Of a mesh, and of a volume whose file states none: its unit of length, mm, um or m; obligatory")
      ->type_name("UNIT");
  app.add_flag(
      "--repair", request.repair,
      "Of a mesh: merge vertices within a millionth of its size, drop triangles that are there twice or have "
      "no area, turn flipped ones; holes stay");
  app.add_flag("--open", request.open,
               "Of a mesh with holes: keep them; from its inner side a point passes through the surface");
  cli::add_quantity(app, "--speed", request.speed_mps, Dimension::speed,
                    "Speed of a nominal position, if none was measured");
  app.add_flag_callback(
      "--no-position", [&request] { request.integrate_speed = false; },
      "Do not integrate a speed channel to a position");
  app.add_flag("--mask-outliers", request.mask_outliers,
               "Remove rows with implausible or missing values: they become gaps and are not filled in");
  app.add_flag("--force", request.replace, "Replace a recording of the same name");
}

void declare_circumstances(CLI::App& app, ImportRequest& request) {
  app.add_option("--date", request.recorded, "Date of the measurement, as 2026-03-14");
  app.add_option("--calibrated", request.calibrated, "Date of the calibration of the scales");
  app.add_option("--subject", request.subject, "A code for the person, never a name");
  app.add_option("--finger", request.finger, "Finger, or object that slid instead of one");
  app.add_option("--surface", request.surface, "Surface that was touched");
  app.add_option("--notes", request.notes, "Notes in free text");
  app.add_option_function<std::string>(
         "--humidity",
         [&request](const std::string& text) { request.humidity_percent = parsed_percent(text); },
         "Relative humidity of the room")
      ->type_name("PERCENT");
}

cli::Report row_of(const schema::Channel& channel, const ChannelRange& range) {
  cli::Report row;
  row.add("name", channel.name).add("quantity", channel.quantity).add("unit", channel.unit);
  row.add("smallest", range.smallest).add("largest", range.largest);
  row.add("scale", channel.scale).add("offset", channel.offset);
  return row.add("from", channel.derivation.empty() ? channel.source : channel.derivation);
}

std::vector<cli::Report> rows_of(const Imported& imported) {
  std::vector<cli::Report> rows;
  for (std::size_t k = 0; k < imported.ranges.size(); ++k)
    rows.push_back(row_of(imported.recording.header.channels[k], imported.ranges[k]));
  return rows;
}

// The channels that `spatial` can make textures of; its default is tangential_force. Three axes of an
// acceleration come as one signal first: one axis alone misses what is across it.
std::vector<std::string> names_for_textures(const schema::RecordingHeader& header) {
  constexpr std::string_view kAxis = "acceleration";
  const bool three_axes = std::ranges::count(header.channels, kAxis, &schema::Channel::quantity) == 3;
  bool reduced = false;
  std::vector<std::string> names;
  for (const std::size_t index : schema::texture_channels(header)) {
    const schema::Channel& channel = header.channels[index];
    if (three_axes && channel.quantity == kAxis && !std::exchange(reduced, true))
      names.push_back("acceleration:dft321");
    names.push_back(channel.name);
  }
  const auto usual = std::ranges::find(names, "tangential_force");
  return usual == names.end() ? names : std::vector{*usual};
}

// A command that can be run unchanged; the other possible channels follow in a shell comment.
std::string next_command(const schema::Recording& recording) {
  const auto& channels = recording.header.channels;
  const bool placed = std::ranges::find(channels, "position", &schema::Channel::quantity) != channels.end();
  const auto textures = names_for_textures(recording.header);
  const std::string name = cli::shell_word(recording.stem);
  if (!placed || textures.empty()) return fmt::format("tactograph info {}", name);
  if (textures.front() == "tangential_force") return fmt::format("tactograph spatial {0} -o {0}", name);
  std::string others;
  for (std::size_t i = 1; i < textures.size(); ++i)
    others += (i == 1 ? "  # or --channel " : ", ") + cli::shell_word(textures[i]);
  return fmt::format("tactograph spatial {0} --channel {1} -o {0}{2}", name,
                     cli::shell_word(textures.front()), others);
}

std::string outliers_of(const Imported& imported, const ImportRequest& request) {
  const auto plural = [](std::uint64_t count) { return count == 1 ? "" : "s"; };
  const std::string samples = fmt::format("{} sample{}", imported.outliers, plural(imported.outliers));
  if (!request.mask_outliers) return samples + "; --mask-outliers makes gaps of their rows";
  return fmt::format("{} in {} row{}, which are now gaps", samples, imported.masked_rows,
                     plural(imported.masked_rows));
}

cli::Report report_on(const Imported& imported, const ImportRequest& request) {
  const schema::RecordingHeader& header = imported.recording.header;
  cli::Report report;
  report.add("source", request.file).add("format", imported.format);
  report.add("frames", header.frames).add("sample_rate_hz", header.sample_rate_hz);
  report.add("duration_s", duration_s(header)).add("clock", header.clock).add("gaps", header.gaps.size());
  if (imported.outliers > 0) report.add("outliers", outliers_of(imported, request));
  if (!header.marks.empty()) report.add("marks", header.marks.size());
  report.add("channels", rows_of(imported));
  if (!header.warnings.empty()) report.add("warnings", header.warnings);
  report.add("files", std::vector{imported.recording.stem + ".wav", imported.recording.stem + ".json"});
  return report.add("next", next_command(imported.recording));
}

// A window of 1 mm, or a quarter of a shorter profile.
std::string next_of_profile(const HeightProfile& profile, const std::string& stem) {
  constexpr std::size_t kFewest = 10;  // samples of a window
  if (profile.height_m.size() < kFewest) return fmt::format("tactograph info {}", cli::shell_word(stem));
  const double length_m = static_cast<double>(profile.height_m.size()) * profile.pitch_m;
  const double window_m = std::max(std::min(1e-3, length_m / 4), kFewest * profile.pitch_m);
  return fmt::format("tactograph spectrogram {} -o {} --window {:.3g}mm", cli::shell_word(stem),
                     cli::shell_word(stem + ".png"), 1e3 * window_m);
}

std::vector<cli::Report> roughness_rows(const HeightProfile& profile) {
  std::vector<cli::Report> rows;
  for (const StatedRoughness& each : profile.roughness) {
    cli::Report row;
    row.add("name", each.name).add("stated_m", each.stated_m).add("computed_m", each.computed_m);
    rows.push_back(std::move(row.add("agrees", each.agrees)));
  }
  return rows;
}

schema::Result<cli::Report> run_profile(const ImportRequest& request) {
  const auto imported = [&] {
    cli::Progress progress("importing");
    return import_profile(request, [&](double fraction) { progress.update(fraction); });
  }();
  TACTO_TRY(imported);
  const auto& [profile, stem] = *imported;
  const auto [lowest, highest] = std::ranges::minmax(profile.height_m);
  cli::Report report;
  report.add("source", request.file).add("quantity", "height");
  report.add("samples", profile.height_m.size()).add("pitch_m", profile.pitch_m);
  report.add("length_m", static_cast<double>(profile.height_m.size() - 1) * profile.pitch_m);
  report.add("direction", profile.direction).add("unevenness_m", profile.unevenness_m);
  report.add("lowest_m", lowest).add("highest_m", highest);
  if (!profile.roughness.empty()) report.add("roughness", roughness_rows(profile));
  report.add("files", std::vector{stem + ".texture.wav", stem + ".texture.json"});
  return report.add("next", next_of_profile(profile, stem));
}

schema::Result<cli::Report> run_height_map(const ImportRequest& request) {
  const auto imported = [&] {
    cli::Progress progress("importing");
    return import_height_map(request, [&](double fraction) { progress.update(fraction); });
  }();
  TACTO_TRY(imported);
  const auto& [map, path] = *imported;
  const schema::HeightFigures figures = figures_of(map);
  cli::Report report;
  report.add("source", request.file).add("quantity", "height");
  report.add("columns", map.columns).add("rows", map.rows).add("pitch_m", map.pitch_m);
  report.add("lowest_m", figures.lowest_m).add("highest_m", figures.highest_m);
  report.add("rms_slope", figures.rms_slope).add("files", std::vector{path});
  return report.add("next", fmt::format("tactograph info {}", cli::shell_word(path)));
}

schema::Result<cli::Report> run_mesh(const ImportRequest& request) {
  const auto imported = import_mesh(request);
  TACTO_TRY(imported);
  cli::Report report;
  report.add("source", request.file);
  schema::add_mesh(report, imported->mesh);
  if (request.repair) {
    const schema::MeshRepair& repair = imported->repair;
    report.add("merged_vertices", repair.merged).add("merged_within_m", imported->merged_within_m);
    report.add("dropped_triangles", repair.dropped).add("turned_triangles", repair.turned);
  }
  report.add("files", std::vector{imported->path});
  return report.add("next", fmt::format("tactograph info {}", cli::shell_word(imported->path)));
}

schema::Result<cli::Report> run_volume(const ImportRequest& request) {
  const auto imported = import_volume(request);
  TACTO_TRY(imported);
  cli::Report report;
  report.add("source", request.file);
  schema::add_volume(report, imported->read.volume);
  if (imported->read.rounding > 0) report.add("rounded_by_at_most", imported->read.rounding);
  if (imported->read.mirrored)
    report.add("turned_round", "the third axis: those of the file are left-handed");
  report.add("files", std::vector{imported->path});
  return report.add("next", fmt::format("tactograph info {}", cli::shell_word(imported->path)));
}

// What an XDF file has, and a command for its first stream of numbers.
schema::Result<cli::Report> list_streams(const Source& source) {
  std::vector<cli::Report> rows;
  const schema::XdfStream* first = nullptr;
  for (const schema::XdfStream& stream : source.xdf->streams) {
    cli::Report row;
    row.add("number", std::uint64_t{stream.id}).add("name", stream.name).add("type", stream.type);
    row.add("format", stream.format).add("channels", fmt::format("{}", fmt::join(stream.labels, ", ")));
    row.add("samples", stream.samples);
    row.add("nominal_rate_hz", stream.nominal_rate_hz).add("not_imported", stream.refusal);
    rows.push_back(std::move(row));
    if (first == nullptr && stream.refusal.empty()) first = &stream;
  }
  cli::Report report;
  report.add("source", source.file).add("format", source.format).add("streams", rows);
  if (!source.xdf->cut.empty()) report.add("warnings", std::vector{source.xdf->cut});
  if (first == nullptr) return report;
  const auto chosen = open_source(source.file, 0, std::to_string(first->id));
  TACTO_TRY(chosen);
  const std::string name = std::filesystem::path(source.file).stem().string();
  const bool unique = !first->name.empty() &&
                      std::ranges::count(source.xdf->streams, first->name, &schema::XdfStream::name) == 1;
  const std::string stream = unique ? cli::shell_word(first->name) : std::to_string(first->id);
  const std::string option = source.xdf_stream ? "" : fmt::format("--stream {} ", stream);
  return report.add("next", fmt::format("tactograph import {} -o {} {}{}", cli::shell_word(source.file),
                                        cli::shell_word(name), option, example_options(*chosen)));
}

// What a MATLAB or XDF file has; no other file is opened without an output.
schema::Result<cli::Report> list_contents(const ImportRequest& request) {
  const auto source = open_source(request.file);
  const bool has_own_reader = is_profile_request(request) || is_height_map_request(request) ||
                              is_mesh_request(request) || is_volume_request(request);
  if (!source && (!has_own_reader || source.error().kind == schema::ErrorKind::not_found))
    return schema::forward_error(source);
  if (!source || !(source->mat || source->xdf) || !request.channels.empty() || !request.stream.empty())
    return schema::fail(schema::ErrorKind::usage, "is required", "--output", "add -o and a name");
  if (source->xdf) return list_streams(*source);
  std::vector<cli::Report> rows;
  for (const schema::MatArray& array : source->mat->arrays) {
    cli::Report row;
    row.add("name", array.name).add("class", array.class_name).add("size", array.size);
    rows.push_back(std::move(row.add("not_imported", array.refusal)));
  }
  cli::Report report;
  report.add("source", request.file).add("format", source->format).add("arrays", rows);
  if (source->columns.empty()) return report;
  const std::string name = std::filesystem::path(request.file).stem().string();
  return report.add("next", fmt::format("tactograph import {} -o {} {}", cli::shell_word(request.file),
                                        cli::shell_word(name), example_options(*source)));
}

schema::Result<cli::Report> run_import(const ImportRequest& request) {
  if (request.name.empty()) return list_contents(request);
  if (is_mesh_request(request)) return run_mesh(request);
  if (is_volume_request(request)) return run_volume(request);
  if (request.unit_m || request.repair || request.open)
    return schema::fail(schema::ErrorKind::usage,
                        "--unit is for an STL, OBJ, PLY or NRRD file, --repair and --open for a mesh",
                        request.file);
  if (is_height_map_request(request)) return run_height_map(request);
  if (request.full_height_m || request.allow_8bit)
    return schema::fail(schema::ErrorKind::usage, "--height and --allow-8bit are for a PNG", request.file);
  if (!is_x3p(request.file) && (request.row || request.column || !request.points.empty()))
    return schema::fail(schema::ErrorKind::usage, "--row, --column and --points are for an X3P file",
                        request.file);
  if (is_profile_request(request)) return run_profile(request);
  schema::Result<Imported> imported = [&] {
    cli::Progress progress("importing");
    return import_file(request, [&](double fraction) { progress.update(fraction); });
  }();
  TACTO_TRY(imported);
  cli::warn_grouped(imported->recording.header.warnings);
  return report_on(*imported, request);
}

cli::Action declare_import(CLI::App& app) {
  auto request = std::make_shared<ImportRequest>();
  declare_data(app, *request);
  declare_circumstances(app, *request);
  return [request] { return run_import(*request); };
}

}  // namespace

const cli::Verb kImportVerb{
    "import",
    "Convert a file of another program to a recording, a height profile to a texture, a PNG or a surface to "
    "a height map, STL, OBJ or PLY to a mesh, NRRD to a volume",
    "tactograph import trial.csv -o trial --rate 10kHz --channel tangential_force=lateral_V*0.444444N"
    " --channel position=encoder_count*0.5um\n"
    "  tactograph import trial.csv -o trial --rate 10kHz --channel normal_force=2*-0.31+1.6647N --speed "
    "40mm/s\n"
    "  tactograph import run7.lvm -o run7 --time-column X_Value*1s --channel acceleration=Voltage*0.5g "
    "--mask-outliers\n"
    "  tactograph import trial.mat -o trial --rate 10kHz --channel tangential_force=data.force*1N\n"
    "  tactograph import trial.xdf -o trial --stream Force --channel tangential_force=Fx*1N\n"
    "  tactograph import tap.flac -o tap\n"
    "  tactograph import edm.xml -o edm\n"
    "  tactograph import profile.csv -o profile --channel position=x*1mm --channel height=z*1um\n"
    "  tactograph import surface.x3p --row 120 -o surface\n"
    "  tactograph import surface.x3p -o surface.height.nc\n"
    "  tactograph import plate.png --pitch 50um --height 200um -o plate\n"
    "  tactograph import part.stl --unit mm -o part\n"
    "  tactograph import ct.nrrd -o ct",
    declare_import};

}  // namespace tacto::capture
