// SPDX-License-Identifier: GPL-3.0-or-later
// A data acquisition card that plays: the firmware's core in a real-time thread of this process, with the
// card's counter, inputs and output behind its hardware layer.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "data-schema/wiring/wiring.hpp"
#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// A device that records position from the counter of the wiring's encoder, and its inputs, by instructions
/// in a real-time thread: at the wiring's rate, or the greatest at which the instructions take half of a
/// period, with a warning. A period that this computer misses is a gap. Nothing is driven. Errors: as for
/// playing.
schema::Result<std::unique_ptr<Device>> open_comedi_counter(const std::string& uri,
                                                            const schema::Wiring& wiring);

/// "comedi:NAME" with NAME.wiring.json. The card is read and written by instructions in each tick, at rates
/// up to that which is measured here: a tick's instructions then take half of its period. The output is at 0
/// V from now on, and after each end but that of a process that dies: then the card keeps its last volts, and
/// the watchdog of the wiring has to open the amplifier's enable. `without_watchdog`: it is not used, and the
/// wiring need not have one. Errors: usage; as read_wiring(); not_found: no card, or no permission;
/// unsuitable: no output, position or watchdog in the wiring, or none such on the card, or a card that is too
/// slow; device: another program uses the output, or the card refuses an instruction.
schema::Result<std::unique_ptr<Device>> open_comedi_to_play(const std::string& uri,
                                                            std::string_view parameters,
                                                            bool without_watchdog);

}  // namespace tacto::firmware_host
