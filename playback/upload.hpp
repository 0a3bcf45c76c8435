// SPDX-License-Identifier: GPL-3.0-or-later
// What was prepared, into a device whose firmware closes the loop.
#pragma once

#include "firmware-host/client.hpp"
#include "playback/prepare.hpp"

namespace tacto::playback {

/// Sends limits, levels, taps, following, energy, gain and, where the setup is gated, which of the device's
/// channels holds the normal force; the device is idle. Then `arm` with source profile at prepared.rate_hz
/// runs the same kernel as core::TickKernel with prepared.setup(), to the bit.
/// Errors: unsuitable, for more samples than the device holds, a touch that it cannot feel, or ticks outside
/// its rates; device, for firmware of protocol 1.0, and as of Client::command().
schema::Result<void> upload(firmware_host::Client& client, const Prepared& prepared);

}  // namespace tacto::playback
