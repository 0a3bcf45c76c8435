// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/derived_position.hpp"

#include <fmt/format.h>

#include <utility>

#include "data-schema/base/quantity.hpp"

namespace tacto::capture {

DerivedPosition::DerivedPosition(std::string derivation) {
  channel_.name = channel_.quantity = "position";
  channel_.unit = "m";
  channel_.derivation = std::move(derivation);
}

DerivedPosition DerivedPosition::nominal(double speed_mps) {
  DerivedPosition made("nominal: " + schema::for_people(speed_mps, schema::Dimension::speed));
  made.nominal_mps_ = speed_mps;
  return made;
}

DerivedPosition DerivedPosition::integrated(const schema::Channel& speed) {
  DerivedPosition made(fmt::format("integrated from {} (trapezoid rule)", speed.name));
  made.scale_ = speed.scale;
  made.offset_ = speed.offset;
  return made;
}

double DerivedPosition::next(const schema::RecordingHeader& header, double stored) {
  for (; gaps_passed_ < header.gaps.size() && header.gaps[gaps_passed_].frame <= frame_; ++gaps_passed_)
    missing_ += header.gaps[gaps_passed_].count;
  const bool first = frame_ == 0;
  const auto tick = static_cast<double>(frame_++ + missing_);
  if (nominal_mps_) return tick / header.sample_rate_hz * *nominal_mps_;
  const double speed_mps = stored * scale_ + offset_;
  const double step_s = (tick - std::exchange(last_tick_, tick)) / header.sample_rate_hz;
  const double before_mps = std::exchange(last_mps_, speed_mps);
  if (!first) position_m_ += (before_mps + speed_mps) / 2 * step_s;
  return position_m_;
}

}  // namespace tacto::capture
