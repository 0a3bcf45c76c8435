// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/identified_band.hpp"

#include <fmt/format.h>

namespace tacto::playback {
namespace {

constexpr double kMargin = 1.1;  // margin beyond the identified frequencies, too narrow for a resonance

}  // namespace

std::optional<std::string> beyond_identified(const schema::Transducer& transducer,
                                             const spatial::Band& band) {
  const auto& found = transducer.identification;
  if (!found || (band.low_hz * kMargin >= found->low_hz && band.high_hz <= kMargin * found->high_hz))
    return std::nullopt;
  return fmt::format(
      "transducer '{}' was identified from {:.4g} to {:.4g} Hz, the drive goes from {:.4g} to {:.4g} Hz: its "
      "model is extrapolated; identify it over the drive's band, or narrow that band (--low, --high of "
      "render)",
      transducer.name, found->low_hz, found->high_hz, band.low_hz, band.high_hz);
}

}  // namespace tacto::playback
