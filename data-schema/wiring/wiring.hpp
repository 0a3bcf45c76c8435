// SPDX-License-Identifier: GPL-3.0-or-later
// NAME.wiring.json: which sensor is wired to which input of a data acquisition card.
#pragma once

#include <optional>
#include <string>
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

struct Wiring {
  std::string name;
  std::string card;    ///< device file
  double rate_hz = 0;  ///< of each input
  std::vector<WiredInput> inputs;
  std::optional<Transducer> transducer;
  std::string transducer_name;  ///< as in the file
  std::string notes;
  std::string extra_json;     ///< members that the schema does not name
  std::string newer_version;  ///< of the file, if its minor version is newer
  std::vector<std::string> unknown_members = {};
};

/// NAME.wiring.json of a stem or file name, and the transducer that it names. Errors: not_found, malformed
/// (also an unknown member), unsupported_version; unsuitable, at FILE#/inputs/N/member: a quantity or a scale
/// that does not exist, a range without length, two channels of one name.
Result<Wiring> read_wiring(const std::string& name);

}  // namespace tacto::schema
