// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/identified_band.hpp"

#include <fmt/format.h>

namespace tacto::playback {
namespace {

constexpr double kAnyway = 1.1;  // beyond the last frequencies: no resonance hides in a tenth

}  // namespace

std::optional<std::string> beyond_identified(const schema::Transducer& transducer,
                                             const spatial::Band& band) {
  const auto& found = transducer.identification;
  if (!found || (band.low_hz * kAnyway >= found->low_hz && band.high_hz <= kAnyway * found->high_hz))
    return std::nullopt;
  return fmt::format(
      "transducer '{}' was identified from {:.4g} to {:.4g} Hz, the drive goes from {:.4g} to {:.4g} Hz: "
      "beyond "
      "that its model is a guess; identify it over that band, or narrow the drive's (--low, --high of "
      "render)",
      transducer.name, found->low_hz, found->high_hz, band.low_hz, band.high_hz);
}

}  // namespace tacto::playback
