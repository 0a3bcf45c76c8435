// SPDX-License-Identifier: GPL-3.0-or-later
// The cheapest way to play that keeps a promise about its error.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/results/budget.hpp"
#include "data-schema/results/trade_table.hpp"
#include "playback/choose/inverse_choices.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// What is asked of a tick.
struct TickBudget {
  schema::Budget error = {};                         ///< of the displacement, re the wanted one
  std::optional<double> max_tick_ns = std::nullopt;  ///< CPU time, by the table
  bool keep_inverse = false;                         ///< the options' kind of inverse was named: it stays
  bool keep_reading = false;                         ///< and so was their interpolation
  /// That plays, and stays while another texture takes the place of one.
  std::optional<InverseChoice> filter = std::nullopt;

  bool asked() const { return error.asked() || max_tick_ns; }
  /// By error, and not by cost.
  bool by_error() const { return error.most_exact() || !error.asked(); }
};

/// A way to read and to undo, and what it comes to.
struct TickChoice {
  wire::Interpolation interpolation = wire::Interpolation::hermite;
  double samples_per_period = 16;  ///< of the finest content of each level
  InverseChoice inverse;
  double reading_error = 0;
  double error = 0;  ///< predicted: an upper bound
  double tick_ns = 0;
  double memory_bytes = 0;  ///< of the samples

  PrepareOptions in(PrepareOptions options) const;
};

/// "hermite, 15 samples a period, 24 taps, 2 ms"
std::string words_of(const TickChoice& choice);

struct TickDecision {
  TickChoice chosen;
  std::vector<std::string>
      reasons;           ///< why, what else there was, what the promise does not cover; a line each
  std::string table;     ///< FoundTradeTable::origin
  bool promised = true;  ///< an error was asked for, and is kept; else the least there was
};

/// Among the table's interpolations ("reading"), the samples per period for which it knows an error, and
/// inverse_choices(): the cheapest by the table whose predicted error is within the asked one; costs within 1
/// ns of each other are alike, then less memory, then less delay decides. Where the most exact is asked for,
/// or no error, the least error that keeps max_tick_ns; errors within 1 % of each other are alike.
///
/// Predicted error = sqrt(2) x reading + inverse + 1.6e-5, an upper bound of the RMS error of the tray's
/// displacement over the band, re the wanted one's: reading is the table's at the points that a period of
/// the finest content of a level's skirts has (samples_per_period / 1.25), inverse the largest error at any
/// frequency of the band, 1.6e-5 the kernel's rounding (-105 dB) and what highest_spatial_frequency() leaves
/// out (-100 dB). sqrt(2): what a level holds beyond the band (up to 2.5 times its edge) may fold into it
/// with its reading's error, and is taken for no stronger than what is in the band.
///
/// The band is what the rate passes (Prepared::passes_to_hz). Not in it: the encoder's steps, changes of
/// speed while looking ahead, speeds beyond max_speed_mps, the ends of a texture and what it is between its
/// own samples, a drive at its limits, and a transducer or finger that is not what the file says.
///
/// Errors: unsuitable, where no choice keeps the error or max_tick_ns (with the best there is and what limits
/// it), where a bender's hysteresis stays, where the table has no readings; and as prepare() for textures.
schema::Result<TickDecision> decide(std::span<const PlacedTexture> textures,
                                    const schema::Transducer& transducer, const PrepareOptions& options,
                                    const TickBudget& budget, const schema::FoundTradeTable& table);

/// The same among filters that were judged before.
schema::Result<TickDecision> decide(std::span<const PlacedTexture> textures,
                                    const std::vector<InverseChoice>& inverses, bool undoes_hysteresis,
                                    const PrepareOptions& options, const TickBudget& budget,
                                    const schema::FoundTradeTable& table);

/// What a tick of this costs by the table, ns: reading, taps, plays. Errors: unsuitable, where the table does
/// not know the interpolation.
schema::Result<double> tick_cost_ns(const schema::TradeTable& table, wire::Interpolation interpolation,
                                    std::size_t taps, bool undoes_hysteresis);

}  // namespace tacto::playback
