// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a transducer is used where somebody measured it.
#pragma once

#include <optional>
#include <string>

#include "data-schema/transducer/transducer.hpp"
#include "spatial/dsp/filter/band.hpp"

namespace tacto::playback {

/// A warning where the drive's band reaches more than a tenth beyond the frequencies over which the
/// transducer's file was identified: there its model is what the fit extrapolates. None of a file that tells
/// nothing of its identification.
std::optional<std::string> beyond_identified(const schema::Transducer& transducer, const spatial::Band& band);

}  // namespace tacto::playback
