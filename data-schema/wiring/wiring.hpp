// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.wiring.json: what is wired to which input, counter and output of a data acquisition card.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/transducer/transducer.hpp"

namespace tacto::schema {

/// One analog input. Physical value = per_volt x volts + at_zero_volt, in the SI unit of the quantity.
struct WiredInput {
  unsigned input = 0;  ///< its number on the card, from 0
  std::string quantity;
  std::string name;  ///< of the channel
  double range_from_v = 0, range_to_v = 0;
  std::string reference;  ///< ground, common or differential
  /// Absent: the output voltage of the transducer, which the wiring then names.
  std::optional<double> per_volt;
  double at_zero_volt = 0;
};

/// The analog output of the drive, to the amplifier's input.
struct WiredOutput {
  unsigned output = 0;
  double range_from_v = 0, range_to_v = 0;
};

/// The counter of a quadrature encoder on the finger. Position = step_m x count.
struct WiredEncoder {
  unsigned counter = 0;               ///< its channel in the subdevice
  std::optional<unsigned> subdevice;  ///< absent: the card's first with counters
  double step_m = 0;
  std::optional<unsigned> pfi_a, pfi_b;  ///< of an NI card with free inputs: where A and B are connected
};

/// A digital output that changes in each tick: a one-shot behind it enables the amplifier while it does.
struct WiredWatchdog {
  unsigned line = 0;
  std::optional<unsigned> subdevice;  ///< absent: the card's first with digital lines
};

struct Wiring {
  std::string name;
  std::string card;    ///< device file
  double rate_hz = 0;  ///< of each input
  std::vector<WiredInput> inputs;
  // For playback.
  std::optional<WiredOutput> output;
  std::optional<WiredEncoder> encoder;
  std::optional<WiredWatchdog> watchdog;
  std::optional<Transducer> transducer;
  std::string transducer_name;  ///< as in the file
  std::string transducer_file;  ///< the same for read_transducer()
  std::string notes;
  std::string extra_json;     ///< members that the schema does not name
  std::string newer_version;  ///< of the file, if its minor version is newer
  std::vector<std::string> unknown_members = {};
};

/// NAME.wiring.json of a stem or file name, and the transducer that it names. Errors: not_found, malformed
/// (also an unknown member), unsupported_version; unsuitable, at FILE#/inputs/N/member: a quantity or a scale
/// that does not exist, a range without length, two channels of one name, an output that the transducer's
/// drive limit exceeds.
Result<Wiring> read_wiring(const std::string& name);

/// What is wired for playback (drive, encoder, watchdog), and where.
std::vector<std::pair<std::string, std::string>> wired_for_playback(const Wiring& wiring);

}  // namespace tacto::schema
