// SPDX-License-Identifier: GPL-3.0-or-later
// What each choice on the way from a texture to the tray costs and errs, on a given texture and transducer.
#pragma once

#include <functional>
#include <vector>

#include "analysis/trade/rows/trade_row.hpp"
#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::analysis {

/// The texture looped under a finger, each choice by itself about the usual one (2 kHz, hermite at 16 samples
/// a period, full inverse of 2 ms, looking ahead; fingers of 25, 100 and 200 mm/s that know their place, the
/// error the worst of the three), and in pairs where they interact:
/// knobs "interpolation", "samples per period", "interpolation x samples per period" (of these the read force
/// alone), "inverse", "inverse, amplitudes alone", "inverse delay", "look ahead", "between counts", "tick
/// rate", "tick rate x inverse", "tick rate x delay compensation", "pyramid", "precision", "hysteresis",
/// "loop". Errors against playback/reference over 15-500 Hz, re the wanted displacement; cost per tick,
/// median CPU time of this thread; memory of the samples; latency of the tray behind the finger, of "loop"
/// from the encoder's edge to its drive. A choice that is refused (an inverse that leaves more than a tenth)
/// has an error of 1 and says so. Some 5 s. Errors: unsuitable, as prepare() has it, for a texture that can't
/// be played at all.
schema::Result<std::vector<TradeRow>> measure_realtime(const schema::Texture& texture,
                                                       const schema::Transducer& transducer,
                                                       const std::function<void(double)>& progress = {});

}  // namespace tacto::analysis
