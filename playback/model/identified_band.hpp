// SPDX-License-Identifier: GPL-3.0-or-later
// Checks whether a drive stays within the frequencies over which its transducer was identified.
#pragma once

#include <optional>
#include <string>

#include "data-schema/transducer/transducer.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

/// A warning if the drive's band exceeds by more than a tenth the frequencies over which the transducer's
/// file was identified, because there the model is extrapolated. None if the file has no data of its
/// identification.
std::optional<std::string> beyond_identified(const schema::Transducer& transducer, const spatial::Band& band);

}  // namespace tacto::playback
