// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/texture_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data-schema/base/quantity.hpp"
#include "spatial/strokes/monotone_path.hpp"

namespace tacto::spatial {
namespace {

// A tenth of the finest encoder's count. A position that rests between two uniform motions is moved by as
// much.
constexpr double kNegligibleMove_m = 1e-8;

}  // namespace

std::vector<TextureWarning> texture_warnings(const schema::Texture& texture) {
  const schema::TextureSource& source = texture.source;
  const PositionError error{source.position_quantum_m, source.position_noise_m};
  std::vector<TextureWarning> warnings;
  const double explained_m = error.error_bound_m() + error.quantum_m;
  if (source.position_moved_m > std::max(explained_m, kNegligibleMove_m))
    warnings.push_back(
        {fmt::format("positions were moved by up to {} to make them increase; their quantum of {} and noise "
                     "of {} explain only {}: the finger moved backwards",
                     schema::length_for_people(source.position_moved_m),
                     schema::length_for_people(error.quantum_m), schema::length_for_people(error.noise_m),
                     schema::length_for_people(explained_m)),
         "positions moved", source.position_moved_m});
  const double highest_per_m = 1 / (2 * texture.signal.pitch_m);
  if (source.mean_speed_mps > 0 && source.filter != "none" && !source.high_per_m &&
      source.high_hz / source.mean_speed_mps > highest_per_m)
    warnings.push_back(
        {fmt::format(
             "{:g} Hz at {} are {}, above the limit of a grid of {} ({}), and are removed: use a finer "
             "--grid or a lower --high",
             source.high_hz, schema::for_people(source.mean_speed_mps, schema::Dimension::speed),
             schema::for_people(source.high_hz / source.mean_speed_mps, schema::Dimension::spatial_frequency),
             schema::length_for_people(texture.signal.pitch_m),
             schema::for_people(highest_per_m, schema::Dimension::spatial_frequency)),
         "band beyond the grid", source.high_hz / source.mean_speed_mps});
  if (source.counter_wraps > 0)
    warnings.push_back(
        {fmt::format("the encoder's {}-bit counter overflowed {} time{}; the position was corrected",
                     source.counter_bits, source.counter_wraps, source.counter_wraps == 1 ? "" : "s"),
         "counter overflow", static_cast<double>(source.counter_wraps)});
  return warnings;
}

std::string rate_warning(const TextureOptions& options, double sample_rate_hz) {
  const double high_hz = options.filter.passed(sample_rate_hz).high_hz;
  const double kept = kept_hz(options.method, sample_rate_hz);
  if (options.filter.method == FilterMethod::none || options.space || high_hz <= kept) return {};
  const bool sinc = options.method == ResampleMethod::sinc;
  return fmt::format(
      "at {:g} Hz the method {} passes 90 % only below {:g} Hz, so the band up to {:g} Hz is not fully "
      "valid: {} a lower --high",
      sample_rate_hz, name_of(options.method), kept, high_hz, sinc ? "use" : "use --method sinc, or");
}

std::string channel_note(const TextureOptions& options, const TouchRecord& record) {
  const schema::Channel& channel = record.channel();
  if (!options.channel.empty() || channel.name == "tangential_force") return {};
  return fmt::format(
      "{}: has no tangential_force; the texture is made of '{}' ({}), the only suitable channel",
      record.where(), channel.name, channel.quantity);
}

}  // namespace tacto::spatial
