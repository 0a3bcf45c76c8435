// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph spatial: a recording's strokes to textures, force against position.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data-schema/cli/progress.hpp"
#include "data-schema/files.hpp"
#include "data-schema/recording.hpp"
#include "data-schema/texture.hpp"
#include "spatial/cli/verbs.hpp"
#include "spatial/make_texture.hpp"
#include "spatial/valid_band.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::Dimension;
using schema::Fault;
using schema::Result;

struct Options {
  std::string recording, output;
  TextureOptions texture;
  std::string band;
  std::optional<double> low_hz, high_hz, from_s, to_s;
  std::optional<int> stroke;
  bool list = false;
};

// A stroke or stretch that is asked for; number 0 for a stretch.
struct Job {
  Stroke stroke;
  int number = 0;
  std::string stem;
};

struct Made {
  Job job;
  schema::Texture texture;
};

std::string where_of_band(const std::string& text) {
  return "--band " + text;
}

Result<Band> parse_band(const std::string& text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos)
    return schema::fail(Fault::usage, "is neither 'off' nor two frequencies", where_of_band(text),
                        "write it like 15Hz..500Hz");
  const auto low = schema::parse_quantity(text.substr(0, dots), Dimension::frequency);
  if (!low) return schema::forward_error(low);
  const auto high = schema::parse_quantity(text.substr(dots + 2), Dimension::frequency);
  if (!high) return schema::forward_error(high);
  return Band{*low, *high};
}

// --band, --low and --high, --filter none: all say the same thing, the filter.
Result<TimeFilter> chosen_filter(const Options& options) {
  TimeFilter filter = options.texture.filter;
  if (options.band == "off") {
    filter.method = FilterMethod::none;
  } else if (!options.band.empty()) {
    const auto band = parse_band(options.band);
    if (!band) return schema::forward_error(band);
    filter.band = *band;
  }
  filter.band.low_hz = options.low_hz.value_or(filter.band.low_hz);
  filter.band.high_hz = options.high_hz.value_or(filter.band.high_hz);
  return filter;
}

Result<schema::Recording> open(const std::string& name) {
  auto recording = schema::open_recording(name);
  if (recording && !recording->header.newer_version.empty())
    cli::warn(fmt::format("{}: is of the newer version {}; what is unknown in it is left alone", name,
                          recording->header.newer_version));
  return recording;
}

Report row_of(const TouchRecord& record, const Stroke& stroke, int number) {
  Report row;
  if (number > 0) row.add("stroke", number);
  row.add("from_s", record.from_s(stroke))
      .add("to_s", record.to_s(stroke))
      .add("direction", stroke.direction);
  row.add("length_m", record.length_m(stroke)).add("mean_speed_mps", record.mean_speed_mps(stroke));
  if (const auto force = record.mean_normal_force_n(stroke)) row.add("normal_force_n", *force);
  return row;
}

Result<Report> list(const TouchRecord& record) {
  std::vector<Report> rows;
  for (std::size_t i = 0; i < record.strokes().size(); ++i)
    rows.push_back(row_of(record, record.strokes()[i], static_cast<int>(i) + 1));
  Report report;
  report.add("recording", record.where()).add("found", rows.size());
  if (!rows.empty()) report.add("strokes", std::move(rows));
  return report;
}

std::string output_stem(const Options& options) {
  const std::string name = options.output.empty() ? schema::stem_of(options.recording, "") : options.output;
  return schema::stem_of(name, ".texture");
}

Result<std::vector<Job>> one_job(const Options& options, const Result<Stroke>& stroke, int number) {
  if (!stroke) return schema::forward_error(stroke);
  return std::vector<Job>{{*stroke, number, output_stem(options)}};
}

Result<std::vector<Job>> all_strokes(const Options& options, const TouchRecord& record) {
  const auto& strokes = record.strokes();
  if (strokes.empty())
    return schema::fail(Fault::unsuitable, "no stroke was found", record.where(),
                        "ask for a stretch with --from and --to");
  const std::string stem = output_stem(options);
  if (strokes.size() == 1) return std::vector<Job>{{strokes.front(), 1, stem}};
  std::vector<Job> jobs;
  for (const Stroke& stroke : strokes) {
    const int number = static_cast<int>(jobs.size()) + 1;
    jobs.push_back({stroke, number, fmt::format("{}-{:02}", stem, number)});
  }
  return jobs;
}

Result<std::vector<Job>> jobs_of(const Options& options, const TouchRecord& record) {
  if (options.stroke) return one_job(options, record.stroke(*options.stroke), *options.stroke);
  if (!options.from_s && !options.to_s) return all_strokes(options, record);
  const Stroke whole{{0, record.header().frames}, 1};
  const double from_s = options.from_s.value_or(record.from_s(whole));
  return one_job(options, record.stretch(from_s, options.to_s.value_or(record.to_s(whole))), 0);
}

// All textures before the first is written: what fails, fails before any file is there. Among several strokes
// found, one that makes no texture is passed over with a warning.
Result<std::vector<Made>> make_all(TextureMaker& maker, const std::vector<Job>& jobs) {
  std::vector<Made> made;
  cli::Progress progress("textures");
  for (const Job& job : jobs) {
    auto texture = maker.make(job.stroke, job.number);
    if (texture) {
      made.push_back({job, std::move(*texture)});
    } else if (jobs.size() == 1 || texture.error().fault != Fault::unsuitable) {
      return schema::forward_error(texture);
    } else {
      cli::warn(fmt::format("stroke {} makes no texture: {}", job.number, schema::message(texture.error())));
    }
    progress.update(static_cast<double>(&job - jobs.data() + 1) / static_cast<double>(jobs.size()));
  }
  if (made.empty())
    return schema::fail(Fault::unsuitable, "none of the strokes found makes a texture",
                        maker.record().where(), "the warnings say why");
  return made;
}

// The key of a texture's RMS, ending in its unit.
std::string rms_key(const schema::Texture& texture) {
  static const std::map<std::string, std::string> kKeys = {
      {"N", "force_rms_n"}, {"m", "rms_m"}, {"m/s", "rms_mps"}, {"m/s^2", "rms_mps2"}, {"V", "rms_v"}};
  const auto found = kKeys.find(texture.unit);
  return found == kKeys.end() ? "rms" : found->second;
}

Report row_of(const TouchRecord& record, const Made& made) {
  const schema::Texture& texture = made.texture;
  Report row = row_of(record, made.job.stroke, made.job.number);
  row.add(rms_key(texture), rms_of(texture));
  const schema::BandPoint band = band_throughout(texture.valid_band);
  row.add("valid_low_per_m", band.low_per_m).add("valid_high_per_m", band.high_per_m);
  row.add("position_moved_m", texture.source.position_moved_m);
  row.add("file", made.job.stem + ".texture.json");
  return row;
}

void add_filter(Report& report, const schema::TextureSource& source) {
  report.add("filter", source.filter);
  if (source.filter != "none")
    report.add("low_hz", source.low_hz).add("high_hz", source.high_hz).add("edges", source.edges);
  if (source.order != 0) report.add("order", source.order);
  report.add("equalised", source.equalised);
}

Report report_of(const TouchRecord& record, const std::vector<Made>& made) {
  const schema::Texture& first = made.front().texture;
  Report report;
  report.add("recording", record.where()).add("channel", record.channel().name);
  if (!first.simulated.empty()) report.add("simulated", first.simulated);
  report.add("grid_m", first.signal.pitch_m);
  add_filter(report, first.source);
  std::vector<Report> rows;
  for (const Made& each : made) rows.push_back(row_of(record, each));
  report.add("textures", std::move(rows));
  return report;
}

Result<Report> act(const Options& options) {
  TextureOptions wanted = options.texture;
  const auto filter = chosen_filter(options);
  if (!filter) return schema::forward_error(filter);
  wanted.filter = *filter;
  const auto recording = open(options.recording);
  if (!recording) return schema::forward_error(recording);
  if (options.list) {
    const auto record = TouchRecord::open(*recording, wanted.channel);
    return record ? list(*record) : schema::forward_error(record);
  }
  auto maker = TextureMaker::open(*recording, wanted);
  if (!maker) return schema::forward_error(maker);
  const auto jobs = jobs_of(options, maker->record());
  if (!jobs) return schema::forward_error(jobs);
  const auto made = make_all(*maker, *jobs);
  if (!made) return schema::forward_error(made);
  for (const Made& each : *made)
    if (const auto written = schema::write_texture(each.job.stem, each.texture); !written)
      return schema::forward_error(written);
  return report_of(maker->record(), *made);
}

void declare_stretch(CLI::App& app, Options& options) {
  auto* stroke = app.add_option("--stroke", options.stroke, "Only this stroke of those found, from 1");
  auto* from = cli::add_quantity(app, "--from", options.from_s, Dimension::time,
                                 "Only the stretch from this time on (default: the recording's start)");
  auto* to = cli::add_quantity(app, "--to", options.to_s, Dimension::time,
                               "Only the stretch up to this time (default: the recording's end)");
  stroke->excludes(from)->excludes(to);
  app.add_flag("--list", options.list, "Only list the strokes found; write nothing");
}

// An option that takes one of some words, shown as "a|b|c".
template <class Enum>
void add_choice(CLI::App& app, const std::string& name, Enum& value,
                const std::vector<std::pair<std::string, Enum>>& choices, const std::string& help) {
  std::vector<std::string> words;
  for (const auto& [word, meaning] : choices) words.push_back(word);
  app.add_option(name, value, help)
      ->transform(CLI::CheckedTransformer(choices).description(""))
      ->type_name(fmt::format("{}", fmt::join(words, "|")))
      ->default_str(words.front());
}

void declare_filter(CLI::App& app, Options& options) {
  TimeFilter& filter = options.texture.filter;
  auto* band =
      app.add_option("--band", options.band, "Frequencies that pass, LOW..HIGH, or off (default 15Hz..500Hz)")
          ->type_name("LOW..HIGH");
  band->excludes(cli::add_quantity(app, "--low", options.low_hz, Dimension::frequency,
                                   "Lowest frequency that passes (default 15Hz)"));
  band->excludes(cli::add_quantity(app, "--high", options.high_hz, Dimension::frequency,
                                   "Highest frequency that passes (default 500Hz)"));
  add_choice<FilterMethod>(app, "--filter", filter.method,
                           {{"fourier", FilterMethod::fourier},
                            {"butterworth", FilterMethod::butterworth},
                            {"none", FilterMethod::none}},
                           "fourier truncates the spectrum, butterworth runs forwards and backwards");
  app.add_option("--order", filter.order, "Order of the Butterworth filter, before it is run both ways")
      ->check(CLI::Range(1, 20));
  add_choice<Edges>(app, "--edges", filter.edges, {{"treated", Edges::treated}, {"none", Edges::none}},
                    "treated keeps the record's ends from ringing, none is the plain filter");
}

cli::Action declare(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  app.add_option("recording", options->recording, "The recording, by name or file")->required();
  app.add_option("-o,--output", options->output,
                 "Name of the texture; of several, NAME-01 and on (default: the recording's)");
  app.add_option("--channel", options->texture.channel, "The channel that becomes the texture");
  declare_stretch(app, *options);
  declare_filter(app, *options);
  cli::add_quantity(app, "--grid", options->texture.pitch_m, Dimension::length,
                    "Distance of the texture's samples");
  add_choice<Equalise>(app, "--equalise", options->texture.equalise,
                       {{"auto", Equalise::automatic}, {"on", Equalise::on}, {"off", Equalise::off}},
                       "Divide by the transducer's sensor response; auto: where the recording names one");
  return [options] { return act(*options); };
}

}  // namespace

const cli::Verb kSpatialVerb{
    "spatial", "Turn the strokes of a recording into textures: force against position",
    "tactograph spatial oak -o oak\n"
    "  tactograph spatial oak --from 4.55s --to 6.85s --band 15Hz..500Hz --grid 1um -o oak-down\n"
    "  tactograph spatial oak --list",
    declare};

}  // namespace tacto::spatial
