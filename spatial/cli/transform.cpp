// SPDX-License-Identifier: GPL-3.0-or-later
// tactograph transform: a texture from textures, by stretching, gain, band-pass and mixing.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "data-schema/base/quantity.hpp"
#include "data-schema/base/unknown_note.hpp"
#include "data-schema/cli/describe.hpp"
#include "data-schema/command/output_options.hpp"
#include "data-schema/texture/texture.hpp"
#include "spatial/cli/verbs.hpp"
#include "spatial/job/spatial_options.hpp"
#include "spatial/texture/make_texture.hpp"
#include "spatial/transform/stretch.hpp"
#include "spatial/transform/transform.hpp"

namespace tacto::spatial {
namespace {

using cli::Report;
using schema::ErrorKind;
using schema::Lengthening;
using schema::Result;
using schema::Texture;

constexpr double kPoorJoint = 0.1, kMuchRemoved = 1e-3;

struct TransformOptions {
  std::vector<std::string> names;
  std::string output, band, weights;
  std::optional<double> stretch, gain;
  Stretch stretched;
  schema::Existing existing = schema::Existing::keep;
};

Result<double> parse_factor(std::string_view text) {
  const auto gain = schema::parse_gain(text);
  if (gain && gain->times_default) return gain->value;
  return schema::fail(ErrorKind::usage, fmt::format("'{}' is not a factor", text), {},
                      "write it as 1.3x or 130%");
}

void add_factor(CLI::App& app, const std::string& name, std::optional<double>& value,
                const std::string& help) {
  auto read = [name, &value](const std::string& text) {
    const auto factor = parse_factor(text);
    if (!factor) throw CLI::ValidationError(name, schema::message(factor.error()));
    value = *factor;
  };
  app.add_option_function<std::string>(name, read, help)->type_name("NUMBER+UNIT(x, %)");
}

Result<std::vector<double>> weights_of(const TransformOptions& options) {
  std::vector<double> weights;
  if (options.weights.empty()) weights.assign(options.names.size(), 1.0);
  for (std::size_t at = 0; at < options.weights.size();) {
    const std::size_t end = std::min(options.weights.find(',', at), options.weights.size());
    auto weight = parse_factor(std::string_view(options.weights).substr(at, end - at));
    if (!weight) weight.error().where = "--weights";
    TACTO_TRY(weight);
    if (*weight == 0)
      return schema::fail(ErrorKind::usage, "a weight must not be 0", "--weights", "leave that texture out");
    weights.push_back(*weight);
    at = end + 1;
  }
  if (weights.size() == options.names.size()) return weights;
  return schema::fail(
      ErrorKind::usage,
      fmt::format("there are {} weights for {} textures", weights.size(), options.names.size()), "--weights",
      "give one for each texture");
}

std::string sidecar_of(const std::string& name) {
  return schema::stem_of(name, ".texture") + ".texture.json";
}

Result<void> check_task(const TransformOptions& options) {
  if (options.names.size() == 1 && !options.stretch && !options.gain && options.band.empty())
    return schema::fail(ErrorKind::usage, "there is nothing to do with one texture", {},
                        "name an operation: --stretch, --gain or --band; or several textures, to mix them");
  if (options.names.size() == 1 && !options.weights.empty())
    return schema::fail(ErrorKind::usage, "is for a mix, and there is one texture", "--weights",
                        "use --gain");
  if (options.stretched.period_m && options.stretched.lengthening == Lengthening::best_fit)
    return schema::fail(ErrorKind::usage, "has no use with --lengthen best", "--period",
                        "leave one of them out");
  if (options.band == "off")
    return schema::fail(ErrorKind::usage, "off: a texture has no filter that could be switched off", "--band",
                        "leave --band out to keep all frequencies");
  for (const std::string& name : options.names)
    if (schema::same_file(sidecar_of(name), sidecar_of(options.output)))
      return schema::fail(ErrorKind::usage, "would replace the texture that it is made from", options.output,
                          "choose another name with -o");
  return schema::check_texture_free(options.output, options.existing);
}

Result<Texture> one_texture(const TransformOptions& options, const std::vector<double>& weights) {
  std::vector<Texture> textures;
  for (const std::string& name : options.names) {
    auto texture = read_transform_source(name);
    TACTO_TRY(texture);
    if (const auto note = schema::unknown_note(sidecar_of(name), *texture); !note.empty()) cli::warn(note);
    textures.push_back(std::move(*texture));
  }
  if (textures.size() == 1) return std::move(textures.front());
  auto mixed = mix(textures, weights);
  TACTO_TRY(mixed);
  const auto has_gain = [](const Texture& texture) { return texture.playback_gain.has_value(); };
  if (!mixed->playback_gain && std::ranges::any_of(textures, has_gain))
    cli::warn("the textures have different default gains of playback: the mix has none");
  const auto differ = [&](auto member) {
    return std::ranges::any_of(textures,
                               [&](const Texture& each) { return each.*member != textures.front().*member; });
  };
  if (differ(&Texture::direction))
    cli::warn(
        "the textures are of strokes in different directions: the mix is stored as one of growing position");
  if (differ(&Texture::source_origin_m))
    cli::warn(
        "the textures begin at different positions on the bench: they are added from the first sample of "
        "each");
  return mixed;
}

Result<Texture> made(const TransformOptions& options) {
  const auto weights = weights_of(options);
  TACTO_TRY(weights);
  auto texture = one_texture(options, *weights);
  if (texture && !options.band.empty()) {
    const auto band = parse_band(options.band, schema::Dimension::spatial_frequency);
    TACTO_TRY(band);
    texture = filtered(*texture, band->low, band->high);
  }
  if (texture && options.stretch) {
    Stretch asked = options.stretched;
    asked.factor = *options.stretch;
    texture = stretch(*texture, asked);
  }
  if (texture && options.gain) texture = with_gain(*texture, *options.gain);
  if (!texture && texture.error().where.empty()) texture.error().where = options.names.front();
  return texture;
}

void warn_of_losses(const Texture& texture) {
  const auto is_empty = [](const schema::BandPoint& point) { return point.high_per_m <= point.low_per_m; };
  if (!texture.valid_band.empty() && std::ranges::all_of(texture.valid_band, is_empty))
    cli::warn("no frequency is valid in the result; 'tactograph info' shows the valid band of each texture");
  for (const schema::TransformStep& step : texture.transform->steps) {
    if (step.removed_share.value_or(0) > kMuchRemoved)
      cli::warn(
          fmt::format("{}: content above {} was removed, because the grid cannot hold it: {:.2g} % of "
                      "the RMS",
                      schema::operation_name(step.operation),
                      schema::for_people(*step.removed_above_per_m, schema::Dimension::spatial_frequency),
                      100 * *step.removed_share));
    if (step.joint_error.value_or(0) > kPoorJoint)
      cli::warn(fmt::format(
          "{} fits poorly: the jumps in value and slope are {:.2g} of their RMS",
          step.joints.value_or(0) > 0 ? "the joint" : "the end of the last period to the beginning",
          *step.joint_error));
  }
}

// Only --gain and --weights multiply by numbers of any size.
Result<void> check_largest(const Texture& texture, const std::string& output) {
  double largest = 0;
  for (const double value : texture.signal.values) largest = std::max(largest, std::abs(value));
  constexpr double kLargest = std::numeric_limits<float>::max();
  if (largest <= kLargest) return {};
  return schema::fail(ErrorKind::unsuitable,
                      fmt::format("its largest value would be {:.3g} {}, above the {:.2g} that a texture's "
                                  "file can store",
                                  largest, texture.unit, kLargest),
                      output, "choose a smaller factor for --gain or --weights");
}

Report report_of(const Texture& texture, const std::string& stem) {
  Report report;
  report.add("length_m", texture.signal.length_m()).add("pitch_m", texture.signal.pitch_m);
  report.add("quantity", texture.quantity).add(schema::key_in("rms", texture.unit), rms_of(texture));
  if (!texture.simulated.empty()) report.add("simulated", texture.simulated);
  schema::add_transform(report, *texture.transform);
  report.add("files", std::vector<std::string>{stem + ".texture.json", stem + ".texture.wav"});
  return report;
}

Result<Report> run_transform(const TransformOptions& options) {
  TACTO_TRY(check_task(options));
  const auto texture = made(options);
  TACTO_TRY(texture);
  TACTO_TRY(check_largest(*texture, options.output));
  schema::PendingFiles pending;
  TACTO_TRY(schema::add_texture(pending, options.output, *texture));
  TACTO_TRY(pending.commit(options.existing));
  warn_of_losses(*texture);
  return report_of(*texture, schema::stem_of(options.output, ".texture"));
}

cli::Action declare_transform(CLI::App& app) {
  auto options = std::make_shared<TransformOptions>();
  app.add_option("TEXTURE", options->names, "Textures of one quantity, by stem or file; several are mixed")
      ->required();
  app.add_option("-o,--output", options->output, "Name of the new texture")->required();
  cli::declare_force(app, options->existing);
  app.add_option("--weights", options->weights,
                 "Of a mix: a factor for each texture, as 1x,50% [all 1x]. Textures are added from their "
                 "first samples; "
                 "the mix is as long as the shortest one, on the finest of their grids")
      ->type_name("FACTOR,FACTOR...");
  app.add_option("--band", options->band, "Keep this band, in cycles per length, as 0.5/mm..10/mm")
      ->type_name("LOW..HIGH");
  add_factor(
      app, "--stretch", options->stretch,
      "Make all spatial periods longer by a factor, as 1.3x, or shorter, as 70%; the texture keeps its "
      "length, to whole periods if it has a period");
  app.add_flag("--keep-slope", options->stretched.keep_slope,
               "Multiply the values by the factor of --stretch, too, so that amplitude / period is unchanged")
      ->needs("--stretch");
  cli::add_choice<std::optional<Lengthening>>(
      app, "--lengthen", options->stretched.lengthening,
      {{"auto", std::nullopt}, {"periods", Lengthening::periods}, {"best", Lengthening::best_fit}},
      "What --stretch makes the length: whole periods, or the old length with a joint where value and slope "
      "fit best; auto: periods, if the texture has a period")
      ->needs("--stretch");
  cli::add_quantity(app, "--period", options->stretched.period_m, schema::Dimension::length,
                    "Period of the texture before --stretch [found by its correlation with itself]")
      ->needs("--stretch");
  add_factor(app, "--gain", options->gain, "Multiply all values by a factor, as 2x; below 0 inverts them");
  app.footer(app.get_footer() +
             "\nThe order is: mix, --band, --stretch, --gain. The sidecar names the textures with their "
             "SHA-256, and the operations.");
  return [options] { return run_transform(*options); };
}

}  // namespace

const cli::Verb kTransformVerb{
    "transform", "Make a texture from textures: stretch it, change its gain or its band, mix several",
    "tactograph transform grating -o grating-130 --stretch 1.3x --keep-slope", declare_transform};

}  // namespace tacto::spatial
