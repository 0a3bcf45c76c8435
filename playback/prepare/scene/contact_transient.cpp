// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/prepare/scene/contact_transient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tacto::playback {

using schema::ErrorKind;
using schema::fail;

namespace {

constexpr double kLeastDecay_per_s = 1;
constexpr double kFrequencyRounding = 1e-9;  // of a frequency

// e^(-a t) cos(w t) and e^(-a t) sin(w t) / w, with w^2 = square - a^2 of either sign.
struct Swing {
  double cosine = 0, sine_s = 0;
};

// The slower one of two decays; a - sqrt(a^2 - square) without the difference.
double slowest_decay_per_s(const Transient& transient) {
  const double a = transient.decay_per_s, below = a * a - transient.square_per_s2;
  return below > 0 ? transient.square_per_s2 / (a + std::sqrt(below)) : a;
}

Swing swing_at(const Transient& transient, double t) {
  const double a = transient.decay_per_s, squared = transient.square_per_s2 - a * a;
  if (squared < 0) {
    const double half = std::sqrt(-squared), slow = std::exp(-slowest_decay_per_s(transient) * t),
                 lost = -std::expm1(-2 * half * t);
    return {slow * (1 - lost / 2), slow * lost / (2 * half)};
  }
  const double w = std::sqrt(squared), left = std::exp(-a * t);
  constexpr double kNoAngle = 1e-150;  // smaller, its sine has lost its digits
  return {left * std::cos(w * t), w * t > kNoAngle ? left * std::sin(w * t) / w : left * t};
}

double frequency_hz(const Transient& transient) {
  const double squared = transient.square_per_s2 - transient.decay_per_s * transient.decay_per_s;
  return std::sqrt(std::max(0.0, squared)) / (2 * std::numbers::pi);
}

double largest_of(const schema::Piece& piece, double schema::Piece::*value) {
  double most = 0;
  for (const schema::Piece& end : slider_ends(piece)) most = std::max(most, end.*value);
  return most;
}

}  // namespace

SlowSurface slow_surface(const schema::HandSurface& model) {
  const double k = model.hand_stiffness_n_per_m, k_s = model.surface_stiffness_n_per_m;
  const double share = k_s / (k + k_s), rest = k / (k + k_s);
  return {k * share,
          rest * rest * model.surface_damping_n_s_per_m + share * share * model.hand_damping_n_s_per_m};
}

// F = b_s x' + k_s x with x'(0) = v and, since the hand's spring is not yet longer, m x''(0) = -b_s v.
std::optional<Transient> transient_of(const schema::Piece& piece) {
  if (piece.transient) {
    const auto& [amplitude, frequency_hz, decay_per_s] = *piece.transient;
    const double w = 2 * std::numbers::pi * frequency_hz;
    return Transient{0, amplitude * w, decay_per_s, decay_per_s * decay_per_s + w * w};
  }
  if (!piece.hand_surface) return std::nullopt;
  const schema::HandSurface& model = *piece.hand_surface;
  const double m = model.hand_mass_kg, b_s = model.surface_damping_n_s_per_m,
               k_s = model.surface_stiffness_n_per_m;
  const SlowSurface slow = slow_surface(model);
  return Transient{model.amplitude * (b_s - slow.damping_n_s_per_m),
                   model.amplitude * (k_s - b_s * b_s / m - slow.stiffness_n_per_m),
                   (model.hand_damping_n_s_per_m + b_s) / (2 * m), (model.hand_stiffness_n_per_m + k_s) / m};
}

double force_at(const Transient& transient, double time_s) {
  const auto [cosine, sine_s] = swing_at(transient, time_s);
  return transient.start_n_s_per_m * cosine +
         (transient.rise_n_per_m + transient.decay_per_s * transient.start_n_s_per_m) * sine_s;
}

schema::Result<core::TransientTable> transient_table(const schema::Piece& piece, double rate_hz,
                                                     const std::string& where) {
  const auto transient = transient_of(piece);
  if (!transient) return core::TransientTable();
  if (const double hz = frequency_hz(*transient); !(2 * hz < (1 - kFrequencyRounding) * rate_hz))
    return fail(ErrorKind::unsuitable,
                fmt::format("a transient of {:g} Hz cannot be played at {:g} Hz", hz, rate_hz),
                where + (piece.transient ? "/transient/frequency_hz" : "/hand_surface"),
                fmt::format("choose it so that it is below half the rate, {:g} Hz", rate_hz / 2));
  if (const double decay = slowest_decay_per_s(*transient); !(decay >= kLeastDecay_per_s))
    return fail(
        ErrorKind::unsuitable, fmt::format("the transient decays by {:.3g} /s only", decay),
        where + (piece.transient ? "/transient/decay_per_s" : "/hand_surface"),
        fmt::format("at least {:g} /s is needed: choose the dampings accordingly", kLeastDecay_per_s));
  const auto [cosine, sine_s] = swing_at(*transient, 1 / rate_hz);
  const double w = std::sqrt(transient->square_per_s2), damped = transient->decay_per_s * sine_s;
  const auto single = [](double value) { return static_cast<float>(value); };
  return core::TransientTable{
      {single(transient->start_n_s_per_m), single(transient->rise_n_per_m / w)},
      {single(cosine + damped - 1), single(w * sine_s), single(-w * sine_s), single(cosine - damped - 1)}};
}

// Where s' is 0: tan(w t) / w = rise / (a rise + square start).
double transient_peak_n_s_per_m(const Transient& transient) {
  const double a = transient.decay_per_s, rise = transient.rise_n_per_m,
               below = a * rise + transient.square_per_s2 * transient.start_n_s_per_m,
               squared = transient.square_per_s2 - a * a, w = std::sqrt(std::abs(squared));
  const double turned = squared > 0 ? std::atan2(w * rise, below) : std::atanh(w * rise / below);
  const double half_turn = squared > 0 && turned < 0 ? std::numbers::pi : 0;
  const double at_s = w > 0 ? (turned + half_turn) / w : rise / below;
  const double later = at_s > 0 && std::isfinite(at_s) ? std::abs(force_at(transient, at_s)) : 0;
  return std::max(std::abs(transient.start_n_s_per_m), later);
}

double transient_stops_kg(const Transient& transient) {
  return (2 * transient.decay_per_s * transient.start_n_s_per_m + transient.rise_n_per_m) /
         transient.square_per_s2;
}

// s'^2 + square s^2 never grows. d is the greatest depth per speed: the contact began within the tick before.
double transient_whole_to_mps(const schema::Piece& piece, const schema::Device& device, double rate_hz) {
  const auto transient = transient_of(piece);
  if (!transient) return INFINITY;
  double most_n = device.peak_force_n;
  for (const schema::DeviceAxis& axis : device.axes) most_n = std::min(most_n, axis.peak_force_n);
  const auto [start, rise, decay, square] = *transient;
  const Transient change{rise, -2 * decay * rise - square * start, decay, square};
  schema::Piece stiffest = piece;
  stiffest.stiffness_n_per_m = largest_of(piece, &schema::Piece::stiffness_n_per_m);
  const double stiffness = steepest_spring_n_per_m(stiffest),
               damping = largest_of(piece, &schema::Piece::damping_n_s_per_m),
               integral = piece.integral_n_per_m_s, tick_s = 1 / rate_hz,
               peak = transient_peak_n_s_per_m(*transient);
  double largest = peak + damping, deep_s = tick_s;
  for (double envelope = peak, t = 0; envelope > peak / 2; t += tick_s) {
    const double s = force_at(*transient, t);
    deep_s = t + tick_s;
    largest = std::max(
        largest, std::abs(s) + damping + stiffness * deep_s + integral * deep_s * (deep_s + tick_s) / 2);
    envelope = std::hypot(s, force_at(change, t) / std::sqrt(square));
  }
  const double steepest =
      std::max((std::abs(start) + damping) * rate_hz, std::hypot(rise, std::sqrt(square) * start));
  return std::min(most_n / largest, device.slew_n_per_s / (steepest + stiffness + integral * deep_s));
}

}  // namespace tacto::playback
