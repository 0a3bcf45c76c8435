// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/render/loop_seam.hpp"

#include <cmath>
#include <cstdint>

#include "playback/prepare/texture_layout.hpp"

namespace tacto::playback {
namespace {

constexpr double kFarther_m = 5e-3;
constexpr std::int64_t kMostPlayedSamples = std::int64_t{1} << 24;

// In a loop the first sample follows the last one, in a mirrored texture the last but one does.
std::size_t sample_at(std::int64_t index, std::int64_t size, bool mirrored) {
  const std::int64_t period = mirrored ? 2 * (size - 1) : size;
  const std::int64_t rest = ((index % period) + period) % period;
  return static_cast<std::size_t>(rest < size ? rest : period - rest);
}

}  // namespace

Ends ends_of(schema::TextureEnds ends) {
  if (ends == schema::TextureEnds::loop) return Ends::loop;
  return ends == schema::TextureEnds::mirror ? Ends::mirror : Ends::stop;
}

PlayedEnds prepared_ends(const schema::Texture& texture, Ends ends) {
  return {ends, ends == Ends::loop ? seam_of_loop(texture.signal, PrepareOptions{}.seam_m) : 0};
}

schema::Result<PlayedSignal> as_played(const schema::Texture& texture, double at_m, const PlayedEnds& ends,
                                       double from_m, double to_m, const std::string& where) {
  if (ends.ends == Ends::stop) return PlayedSignal{texture.signal, at_m};
  const schema::SpaceSignal one =
      ends.ends == Ends::loop ? looped(texture.signal, ends.seam_m) : texture.signal;
  const double pitch_m = one.pitch_m;
  const auto first = static_cast<std::int64_t>(std::floor((from_m - kFarther_m - at_m) / pitch_m));
  const auto last = static_cast<std::int64_t>(std::ceil((to_m + kFarther_m - at_m) / pitch_m));
  if (last - first > kMostPlayedSamples)
    return schema::fail(schema::ErrorKind::unsuitable, "was played over too long a path to be judged", where);
  PlayedSignal endless{{pitch_m, 0, {}}, at_m + static_cast<double>(first) * pitch_m};
  const auto size = static_cast<std::int64_t>(one.values.size());
  for (std::int64_t i = first; i <= last; ++i)
    endless.signal.values.push_back(one.values[sample_at(i, size, ends.ends == Ends::mirror)]);
  return endless;
}

}  // namespace tacto::playback
