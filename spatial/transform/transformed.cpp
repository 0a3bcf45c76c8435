// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/transform/transformed.hpp"

#include "data-schema/base/creation_time.hpp"
#include "data-schema/version.hpp"

namespace tacto::spatial {

schema::Texture transformed(const schema::Texture& texture, std::vector<double> values,
                            schema::TransformStep step) {
  schema::Texture result;
  result.signal = {texture.signal.pitch_m, texture.signal.origin_m, std::move(values)};
  result.quantity = texture.quantity;
  result.unit = texture.unit;
  result.direction = texture.direction;
  result.source_origin_m = texture.source_origin_m;
  result.valid_band = texture.valid_band;
  result.playback_gain = texture.playback_gain;
  result.transform = texture.transform.value_or(schema::TextureTransform{});
  result.transform->steps.push_back(std::move(step));
  result.simulated = texture.simulated;
  result.surface = texture.surface;
  result.subject = texture.subject;
  result.finger = texture.finger;
  result.notes = texture.notes;
  result.created = schema::creation_time();
  result.creator = kCreator;
  return result;
}

}  // namespace tacto::spatial
