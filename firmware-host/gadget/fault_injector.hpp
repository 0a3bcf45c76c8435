// SPDX-License-Identifier: GPL-3.0-or-later
// Passes frames from the core to the cable, with the faults of a plan.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "firmware-host/gadget/burst_queue.hpp"
#include "firmware-host/gadget/fault_plan.hpp"

namespace tacto::firmware_host {

class FaultInjector {
 public:
  using Send = std::function<void(std::span<const std::uint8_t> bytes, BurstEnd end)>;

  FaultInjector(const FaultPlan& plan, Send send) : plan_(plan), send_(std::move(send)) {}

  /// Precondition: whole frames.
  void pass(std::span<const std::uint8_t> frames);

 private:
  void pass_frame(std::span<const std::uint8_t> frame);
  void pass_samples(std::vector<std::uint8_t>& frame);
  void claim_version(std::span<std::uint8_t> frame) const;
  void emit(std::span<const std::uint8_t> bytes);

  FaultPlan plan_;
  Send send_;
  std::uint64_t frames_ = 0, samples_ = 0;
};

}  // namespace tacto::firmware_host
