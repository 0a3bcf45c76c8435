// SPDX-License-Identifier: GPL-3.0-or-later
// What was delivered in one interval, by its session alone.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "data-schema/experiment/journal.hpp"
#include "data-schema/experiment/protocol.hpp"
#include "data-schema/session/session.hpp"
#include "playback/strokes/stroke_report.hpp"

namespace tacto::analysis {

/// The facts of a session; the same whenever they are computed. Ticks and drive are recorded; the
/// displacement is that of the transducer's model; the normal force is in no session. Errors: not_found;
/// malformed, for a file without a header.
schema::Result<schema::IntervalFacts> interval_facts(const std::string& session);

/// RMS of the displacement that a session predicts for a stroke (0: the longest one). Errors: those of
/// read_session_stroke.
schema::Result<double> predicted_rms_m(const std::string& session, std::uint64_t stroke = 0);

/// Adds a tick to the counts.
void count_tick(const schema::SessionTick& tick, schema::IntervalFacts& facts);
/// Speeds and errors of the strokes of an interval.
void add_strokes(std::span<const playback::PlayedStroke> strokes, schema::IntervalFacts& facts);

/// Which limits the facts exceed, as far as they are known: counts, what the limits removed (unknown is a
/// reason), error and speeds of strokes.
std::vector<std::string> reasons_by_limits(const schema::IntervalFacts& facts,
                                           const schema::DeliveryLimits& limits);

/// Why an interval is not delivered, each reason in words without the stimulus; empty: it is. `sha256` is
/// that of the stimulus by the key.
std::vector<std::string> reasons_against(const schema::IntervalFacts& facts, const schema::Protocol& protocol,
                                         const std::string& sha256);

/// The same for all intervals of an attempt. In an ordering, which has several intervals of one stimulus,
/// those of a stimulus count only if none of them was delivered. `late_start` holds further reasons, which
/// are in no session.
schema::DeliveryJudged judged_delivery(int attempt, std::vector<schema::IntervalFacts> intervals,
                                       const std::vector<std::string>& sha256,
                                       const schema::Protocol& protocol,
                                       const std::vector<std::string>& late_start);

}  // namespace tacto::analysis
