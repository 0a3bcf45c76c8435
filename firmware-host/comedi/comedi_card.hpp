// SPDX-License-Identifier: GPL-3.0-or-later
// A card of the kernel's comedi, and what a wiring names on it. Only sources of this folder include this.
#pragma once

#include <comedilib.h>

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "data-schema/base/error.hpp"
#include "data-schema/recording/recording.hpp"
#include "data-schema/wiring/wiring.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

struct CloseComedi {
  void operator()(comedi_t* card) const { comedi_close(card); }
};
using ComediCard = std::unique_ptr<comedi_t, CloseComedi>;

/// The wiring of a URI, whose text after "comedi:" is `parameters`. Errors: usage: no name; as read_wiring().
schema::Result<schema::Wiring> read_comedi_wiring(const std::string& uri, std::string_view parameters);

/// Errors: not_found: no such card, or no permission.
schema::Result<ComediCard> open_comedi_card(const schema::Wiring& wiring);
/// URI, name ("pci-6221 at /dev/comedi0"), serial (a card has none; the calibration belongs to the wiring's
/// name), firmware (the kernel's comedi and driver) and transducer; the caller sets the rest.
Capabilities described(comedi_t* card, const schema::Wiring& wiring, const std::string& uri);
/// Of the kernel's comedi, as in "0.7.76".
std::string comedi_version(comedi_t* card);

/// The range of volts with these ends; `what` is the channel in words. Errors: unsuitable, with its ranges.
schema::Result<unsigned> comedi_range_of(comedi_t* card, const schema::Wiring& wiring, unsigned subdevice,
                                         unsigned channel, double from_v, double to_v,
                                         const std::string& what);

/// The subdevice of one of these types (comedi.h) that has the channel; `asked`: it must be this one. `what`
/// names such a channel. Errors: unsuitable.
schema::Result<unsigned> find_comedi_channel(comedi_t* card, const schema::Wiring& wiring,
                                             std::initializer_list<int> types, std::optional<unsigned> asked,
                                             unsigned channel, const std::string& what);

struct ComediInput {
  unsigned packed = 0;  ///< channel, range and reference
  unsigned shift = 0;   ///< bits that 32 have more than the converter
  double code_v = 0;    ///< of one code
  schema::Channel channel;

  /// Codes are stored left-justified in 32 bits, as those of all devices.
  std::int32_t justified(std::uint32_t code) const {
    return std::bit_cast<std::int32_t>((code << shift) ^ 0x80000000U);
  }
};

/// Errors: unsuitable: no such input or range, or codes that are no whole number of bits.
schema::Result<ComediInput> find_comedi_input(comedi_t* card, const schema::Wiring& wiring,
                                              unsigned subdevice, const schema::WiredInput& input);

}  // namespace tacto::firmware_host
