// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/texture_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

Result<void> check_playable(const schema::Texture& texture) {
  if (texture.unit != "N")
    return fail(ErrorKind::unsuitable,
                fmt::format("the texture contains {} in {}", texture.quantity, texture.unit), "texture",
                "only force in N can be played");
  if (texture.signal.values.size() < 2 || !(texture.signal.pitch_m > 0))
    return fail(ErrorKind::unsuitable, "the texture has fewer than 2 samples", "texture");
  const auto& values = texture.signal.values;
  const auto bad = std::ranges::find_if(values, [](double value) { return !std::isfinite(value); });
  if (bad != values.end())
    return fail(ErrorKind::unsuitable, "the texture's value is not a finite number",
                fmt::format("texture, sample {}", bad - values.begin()));
  return {};
}

}  // namespace tacto::playback
