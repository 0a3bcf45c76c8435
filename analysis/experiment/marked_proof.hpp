// SPDX-License-Identifier: GPL-3.0-or-later
// What was delivered between the marks that a client of the daemon put into a session.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "data-schema/experiment/journal.hpp"
#include "data-schema/experiment/protocol.hpp"

namespace tacto::analysis {

enum class Delivered { yes, no, unknown };

/// From a mark to the next one, or to the end of the session. The mark `end` begins none.
struct MarkedInterval {
  std::string mark;
  std::uint64_t from_tick = 0, to_tick = 0;  ///< the first one, and the first one after it
  double from_s = 0, to_s = 0;               ///< of its first and last tick, since the session's first tick
  schema::IntervalFacts facts;               ///< of its ticks and of the whole strokes in it
  Delivered delivered = Delivered::unknown;
  std::vector<std::string> why;  ///< not delivered: each reason; unknown: what is missing
};

struct MarkedProof {
  std::vector<MarkedInterval> intervals;
  bool same_to_the_bit = false;  ///< the whole session, computed again
  std::string simulated;         ///< by which device; empty: a real one
};

/// Whether a name is that of a session, and not of a run.
bool names_session(const std::string& name);

/// `name`: a session. Delivered is unknown where no limit is exceeded and the error of whole strokes is
/// unknown. Memory is that of the strokes in the intervals. Errors: as SessionReader::open, report_strokes;
/// unsuitable: no mark that begins an interval, a session of forces. `tell` receives 0 to 1.
schema::Result<MarkedProof> prove_marks(const std::string& name, const schema::DeliveryLimits& limits,
                                        const std::function<void(double)>& tell);

}  // namespace tacto::analysis
