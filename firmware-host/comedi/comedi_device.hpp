// SPDX-License-Identifier: GPL-3.0-or-later
// A data acquisition card as a device that records: a driver of the kernel's comedi, through libcomedi. The
// card samples by its own clock.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "firmware-host/link/device.hpp"

namespace tacto::firmware_host {

/// "comedi:NAME" with NAME.wiring.json; with an encoder open_comedi_counter(). The rate is the card's nearest
/// one, with a warning if it is another than the wiring's. Errors: usage; as read_wiring(); not_found: no
/// card, or no permission; unsuitable: the card has no such input, range or rate, or cannot sample by its own
/// clock.
schema::Result<std::unique_ptr<Device>> open_comedi_device(const std::string& uri,
                                                           std::string_view parameters);

}  // namespace tacto::firmware_host
