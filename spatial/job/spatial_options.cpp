// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/job/spatial_options.hpp"

#include "data-schema/command/output_options.hpp"

namespace tacto::spatial {
namespace {

using schema::Dimension;
using schema::ErrorKind;
using schema::Result;

std::string where_of_band(const std::string& text) {
  return "--band " + text;
}

Result<SpaceFilter> space_filter(const SpatialOptions& options) {
  const TimeFilter& filter = options.texture.filter;
  if (options.band.empty())
    return schema::fail(ErrorKind::usage, "--band-in space has no default band", {},
                        "give it with --band, as 0.5/mm..10/mm");
  const auto band = parse_band(options.band, Dimension::spatial_frequency);
  TACTO_TRY(band);
  return SpaceFilter{filter.method, band->low, band->high, filter.edges, filter.order};
}

void declare_stretch(CLI::App& app, SpatialOptions& options) {
  auto* stroke = app.add_option("--stroke", options.stroke, "Only the stroke of this number, from 1");
  auto* from = cli::add_quantity(app, "--from", options.from_s, Dimension::time,
                                 "Start of the time range (default: start of the recording)");
  auto* to = cli::add_quantity(app, "--to", options.to_s, Dimension::time,
                               "End of the time range (default: end of the recording)");
  stroke->excludes(from)->excludes(to);
  app.add_flag("--finger-up", options.finger_up,
               "Include strokes in which, by the normal force, the finger does not touch the surface");
  app.add_flag("--list", options.list, "Only list the strokes; write no file");
  auto* average = app.add_flag("--average", options.average,
                               "Mean of all strokes of a direction, and their standard deviation; of several "
                               "recordings one mean if -o is a name, else one of each");
  average->excludes(stroke)->excludes(from)->excludes(to);
}

void declare_average(CLI::App& app, SpatialOptions& options) {
  app.add_flag("--both-ways", options.both_ways, "Average strokes of both directions into one")
      ->needs("--average");
  app.add_flag("--mix", options.mix,
               "Average recordings of different surfaces, or measured with simulated ones")
      ->needs("--average");
  cli::add_choice<Align>(
      app, "--align", options.align, {{"position", Align::position}, {"correlation", Align::correlation}},
      "Align strokes by their position on the bench, or by best correlation with those before")
      ->needs("--average");
  cli::add_quantity(app, "--align-range", options.align_range_m, Dimension::length,
                    "Largest shift of --align correlation")
      ->needs("--average");
}

void declare_filter(CLI::App& app, SpatialOptions& options) {
  TimeFilter& filter = options.texture.filter;
  auto* band = app.add_option("--band", options.band, "Pass band, LOW..HIGH, or off (default 15Hz..500Hz)")
                   ->type_name("LOW..HIGH");
  auto* band_in = cli::add_choice<BandIn>(app, "--band-in", options.band_in,
                                          {{"time", BandIn::time}, {"space", BandIn::space}},
                                          "Band-pass over time, before resampling, or along position, after "
                                          "it (then --band is in cycles per length)");
  auto* low = cli::add_quantity(app, "--low", options.low_hz, Dimension::frequency,
                                "Lowest frequency that passes (default 15Hz)");
  auto* high = cli::add_quantity(app, "--high", options.high_hz, Dimension::frequency,
                                 "Highest frequency that passes (default 500Hz)");
  band->excludes(low)->excludes(high);
  band_in->excludes(low)->excludes(high);
  cli::add_choice<FilterMethod>(app, "--filter", filter.method,
                                {{"fourier", FilterMethod::fourier},
                                 {"butterworth", FilterMethod::butterworth},
                                 {"none", FilterMethod::none}},
                                "fourier truncates the spectrum; butterworth filters forwards and backwards");
  app.add_option("--order", filter.order, "Order of the Butterworth filter; two passes double it")
      ->check(CLI::Range(1, 20));
  cli::add_choice<Edges>(app, "--edges", filter.edges, {{"treated", Edges::treated}, {"none", Edges::none}},
                         "treated avoids ringing at the ends of the record; none is the plain filter");
}

}  // namespace

Result<BandLimits> parse_band(const std::string& text, Dimension dimension) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos)
    return schema::fail(
        ErrorKind::usage, "is not a pair of frequencies", where_of_band(text),
        dimension == Dimension::frequency ? "write it as 15Hz..500Hz, or off" : "write it as 0.5/mm..10/mm");
  const auto end = [&](const std::string& words) -> Result<double> {
    auto value = schema::parse_quantity(words, dimension);
    if (!value) value.error().where = where_of_band(text);
    return value;
  };
  const auto low = end(text.substr(0, dots)), high = end(text.substr(dots + 2));
  TACTO_TRY(low);
  TACTO_TRY(high);
  if (*low < *high) return BandLimits{*low, *high};
  return schema::fail(ErrorKind::usage, "the limits of the band do not increase", where_of_band(text),
                      "write the lower end first");
}

void declare_spatial(CLI::App& app, SpatialOptions& options) {
  app.add_option("recording", options.recordings, "Recordings, by name or file, or folders of them")
      ->required();
  app.add_option(
      "-o,--output", options.output,
      "Name of the texture; of several strokes, NAME-01, NAME-02 ... (default: name of the recording). For "
      "several recordings a folder, or a name in which {} stands for the name of the recording");
  cli::declare_force(app, options.existing);
  app.add_option("--jobs", options.jobs, "Number of recordings processed at the same time")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_option("--channel", options.texture.channel,
                 "Channel of the texture [tangential_force, else the only suitable one]. "
                 "acceleration:dft321, or x,y,z:dft321 by their names: three axes as one signal with the "
                 "magnitude of their spectra; the waveform is not kept");
  declare_stretch(app, options);
  declare_average(app, options);
  declare_filter(app, options);
  cli::add_quantity(app, "--grid", options.pitch_m, Dimension::length,
                    "Distance between samples of the texture [1um, or by --quality]");
  cli::add_choice<std::optional<ResampleMethod>>(
      app, "--method", options.method, {{"hermite", ResampleMethod::hermite}, {"sinc", ResampleMethod::sinc}},
      "Resampling: monotone cubics with their true inverse, or a windowed sinc at the true inverse (error "
      "3e-7 up to 0.3 of the sample rate, ten times slower; cubics "
      "pass 90 % up to 0.24 of the rate) [hermite, or by --quality]");
  cli::declare_budget(app, options.chosen_by, "method and grid");
  cli::add_choice<Equalise>(app, "--equalise", options.texture.equalise,
                            {{"auto", Equalise::automatic}, {"on", Equalise::on}, {"off", Equalise::off}},
                            "Divide by the response of the transducer's sensor; auto: if the channel is a "
                            "tangential force and the recording contains a transducer");
}

// --band, --low and --high, and --filter none are alternatives for the filter.
Result<TextureOptions> texture_options(const SpatialOptions& options) {
  TextureOptions texture = options.texture;
  texture.method = options.method.value_or(texture.method);
  texture.pitch_m = options.pitch_m.value_or(texture.pitch_m);
  if (options.band == "off") {
    texture.filter.method = FilterMethod::none;
  } else if (options.band_in == BandIn::space) {
    const auto space = space_filter(options);
    TACTO_TRY(space);
    texture.space = *space;
  } else if (!options.band.empty()) {
    const auto band = parse_band(options.band, Dimension::frequency);
    TACTO_TRY(band);
    texture.filter.band = {band->low, band->high};
  }
  texture.filter.band.low_hz = options.low_hz.value_or(texture.filter.band.low_hz);
  texture.filter.band.high_hz = options.high_hz.value_or(texture.filter.band.high_hz);
  return texture;
}

}  // namespace tacto::spatial
