// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the cheapest playback choices whose predicted error keeps a budget.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data-schema/results/budget.hpp"
#include "data-schema/results/trade_table.hpp"
#include "playback/prepare/prepare.hpp"

namespace tacto::playback {

/// A filter that prepare() would make, with its error.
struct InverseChoice {
  Inverse inverse = Inverse::full;
  double delay_s = 0;
  std::uint16_t taps = 0;
  double error = 0;  ///< largest_inverse_error()

  /// The options with this filter.
  PrepareOptions in(PrepareOptions options) const;
};

/// All useful filters at this rate: full, of 8 to 128 taps and 0.5 to 4 ms (as far as the taps reach), and
/// the gain alone. `keep_inverse`: only the kind in the options. They are designed and judged here for this
/// transducer, not taken from a table, in some 0.2 s. In order of taps.
std::vector<InverseChoice> inverse_choices(const schema::Transducer& transducer,
                                           const PrepareOptions& options, bool keep_inverse);

/// The budget of a tick.
struct TickBudget {
  schema::Budget error = {};                         ///< of the displacement, re the target
  std::optional<double> max_tick_ns = std::nullopt;  ///< CPU time, from the table
  bool keep_inverse = false;                         ///< the kind of inverse was named and is kept
  bool keep_reading = false;                         ///< the interpolation was named and is kept
  /// The filter of the running playback, which is kept while another texture replaces the current one.
  std::optional<InverseChoice> filter = std::nullopt;

  bool asked() const { return error.asked() || max_tick_ns; }
  /// Whether the choice is for least error, and not for least cost.
  bool by_error() const { return error.most_exact() || !error.asked(); }
};

/// An interpolation and an inverse, with their error and cost.
struct TickChoice {
  wire::Interpolation interpolation = wire::Interpolation::hermite;
  double samples_per_period = 16;  ///< of the finest content of each level
  InverseChoice inverse;
  double reading_error = 0;
  double error = 0;  ///< predicted upper bound
  double tick_ns = 0;
  double memory_bytes = 0;  ///< of the samples

  PrepareOptions in(PrepareOptions options) const;
};

/// "hermite, 15 samples a period, 24 taps, 2 ms"
std::string words_of(const TickChoice& choice);

struct TickDecision {
  TickChoice chosen;
  std::vector<std::string>
      reasons;           ///< why, the alternatives, what the prediction does not cover; a line each
  std::string table;     ///< FoundTradeTable::origin
  bool promised = true;  ///< an error was requested and is kept; otherwise it is the smallest possible
};

/// Chooses among the table's interpolations ("reading"), the samples per period for which it has an error,
/// and inverse_choices(): the cheapest by the table whose predicted error is within the budget. Costs within
/// 1 ns are equal; then less memory decides, then less delay. If the smallest error is requested, or none, it
/// is the choice with the smallest error that keeps max_tick_ns; errors within 1 % are equal.
///
/// Predicted error = sqrt(2) x reading + inverse + 1.6e-5, an upper bound of the RMS error of the tray's
/// displacement over the band, re the target's. Reading is the table's error at the number of points per
/// period of the finest content in a level's skirts (samples_per_period / 1.25). Inverse is the largest error
/// at any frequency of the band. 1.6e-5 is the kernel's rounding (-105 dB) plus what
/// highest_spatial_frequency() omits (-100 dB). sqrt(2): the content of a level beyond the band (up to 2.5
/// times its edge) may alias into it with its interpolation error; it is assumed to be no larger than the
/// content of the band.
///
/// The band ends at the frequency that the rate permits (Prepared::passes_to_hz). Not included: the encoder's
/// steps, changes of speed while looking ahead, speeds beyond max_speed_mps, the ends of a texture and its
/// shape between its own samples, a drive at its limits, and a transducer or finger that differs from the
/// file.
///
/// Errors: unsuitable, if no choice keeps the error or max_tick_ns (with the best one and what limits it), if
/// a bender's hysteresis stays, if the table has no interpolations; and as prepare() for textures.
schema::Result<TickDecision> decide(std::span<const PlacedTexture> textures,
                                    const schema::Transducer& transducer, const PrepareOptions& options,
                                    const TickBudget& budget, const schema::FoundTradeTable& table);

/// The same for filters that are judged already.
schema::Result<TickDecision> decide(std::span<const PlacedTexture> textures,
                                    const std::vector<InverseChoice>& inverses, bool undoes_hysteresis,
                                    const PrepareOptions& options, const TickBudget& budget,
                                    const schema::FoundTradeTable& table);

/// The cost of a tick by the table, ns: interpolation, taps, play operators. Errors: unsuitable, if the table
/// has no such interpolation.
schema::Result<double> tick_cost_ns(const schema::TradeTable& table, wire::Interpolation interpolation,
                                    std::size_t taps, bool undoes_hysteresis);

}  // namespace tacto::playback
