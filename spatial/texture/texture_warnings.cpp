// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/texture_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data-schema/base/quantity.hpp"
#include "spatial/strokes/monotone_path.hpp"

namespace tacto::spatial {
namespace {

// A tenth of the finest encoder's count: so much a position that rests between two even motions is moved.
constexpr double kNothing_m = 1e-8;

}  // namespace

std::vector<TextureWarning> texture_warnings(const schema::Texture& texture) {
  const schema::TextureSource& source = texture.source;
  const PositionError error{source.position_quantum_m, source.position_noise_m};
  std::vector<TextureWarning> warnings;
  const double explained_m = error.explains_m() + error.quantum_m;
  if (source.position_moved_m > std::max(explained_m, kNothing_m))
    warnings.push_back(
        {fmt::format("positions were moved by up to {} to make them grow; their quantum of {} and noise of "
                     "{} explain {}: "
                     "the finger went back on its way",
                     schema::length_for_people(source.position_moved_m),
                     schema::length_for_people(error.quantum_m), schema::length_for_people(error.noise_m),
                     schema::length_for_people(explained_m)),
         "positions moved", source.position_moved_m});
  const double highest_per_m = 1 / (2 * texture.signal.pitch_m);
  if (source.mean_speed_mps > 0 && source.filter != "none" && !source.high_per_m &&
      source.high_hz / source.mean_speed_mps > highest_per_m)
    warnings.push_back(
        {fmt::format(
             "{:g} Hz at {} are {}, beyond what a grid of {} holds ({}), and left out: choose a finer "
             "--grid, or "
             "a lower --high",
             source.high_hz, schema::for_people(source.mean_speed_mps, schema::Dimension::speed),
             schema::for_people(source.high_hz / source.mean_speed_mps, schema::Dimension::spatial_frequency),
             schema::length_for_people(texture.signal.pitch_m),
             schema::for_people(highest_per_m, schema::Dimension::spatial_frequency)),
         "band beyond the grid", source.high_hz / source.mean_speed_mps});
  if (source.counter_wraps > 0)
    warnings.push_back(
        {fmt::format("the encoder's {}-bit counter ran over {} time{}, and was corrected",
                     source.counter_bits, source.counter_wraps, source.counter_wraps == 1 ? "" : "s"),
         "counter ran over", static_cast<double>(source.counter_wraps)});
  return warnings;
}

std::string rate_warning(const TextureOptions& options, double sample_rate_hz) {
  const double high_hz = options.filter.passed(sample_rate_hz).high_hz;
  const double kept = kept_hz(options.method, sample_rate_hz);
  if (options.filter.method == FilterMethod::none || options.space || high_hz <= kept) return {};
  const bool sinc = options.method == ResampleMethod::sinc;
  return fmt::format(
      "at {:g} Hz the method {} keeps nine tenths of what lies below {:g} Hz only, so the band to "
      "{:g} Hz is not all valid: {} a lower --high",
      sample_rate_hz, name_of(options.method), kept, high_hz, sinc ? "choose" : "choose --method sinc, or");
}

std::string channel_note(const TextureOptions& options, const TouchRecord& record) {
  const schema::Channel& channel = record.channel();
  if (!options.channel.empty() || channel.name == "tangential_force") return {};
  return fmt::format(
      "{}: has no tangential_force; the texture is of '{}' ({}), the only channel that can be one",
      record.where(), channel.name, channel.quantity);
}

}  // namespace tacto::spatial
