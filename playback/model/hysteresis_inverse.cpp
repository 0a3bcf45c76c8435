// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/model/hysteresis_inverse.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "playback/model/chain.hpp"

namespace tacto::playback {
namespace {

struct Play {
  double threshold_v = 0, weight = 0;
};

// Merging loses the corner between the two: its size is the product of the weights over their sum, times the
// distance of the thresholds.
double merging_loss(const Play& a, const Play& b) {
  const double sum = a.weight + b.weight;
  return sum > 0 ? a.weight * b.weight / sum * (b.threshold_v - a.threshold_v) : 0;
}

Play merged(const Play& a, const Play& b) {
  const double sum = a.weight + b.weight;
  if (!(sum > 0)) return a;
  return {(a.weight * a.threshold_v + b.weight * b.threshold_v) / sum, sum};
}

void merge_nearest(std::vector<Play>& play_operators) {
  std::size_t best = 0;
  for (std::size_t i = 1; i + 1 < play_operators.size(); ++i)
    if (merging_loss(play_operators[i], play_operators[i + 1]) <
        merging_loss(play_operators[best], play_operators[best + 1]))
      best = i;
  play_operators[best] = merged(play_operators[best], play_operators[best + 1]);
  play_operators.erase(play_operators.begin() + static_cast<std::ptrdiff_t>(best) + 1);
}

// The sum of the operators after the input has moved to v.
double moved_plays(const schema::Hysteresis& hysteresis, double v, std::span<double> play_operators) {
  double sum = 0;
  for (std::size_t i = 0; i < play_operators.size(); ++i) {
    const double r = hysteresis.thresholds_v[i];
    play_operators[i] = std::max(v - r, std::min(v + r, play_operators[i]));
    sum += hysteresis.weights[i] * play_operators[i];
  }
  return sum;
}

}  // namespace

wire::Hysteresis inverse_of(const schema::Hysteresis& hysteresis) {
  std::vector<Play> play_operators;
  for (std::size_t i = 1; i < hysteresis.weights.size(); ++i)
    if (hysteresis.weights[i] > 0)
      play_operators.push_back({hysteresis.thresholds_v[i], hysteresis.weights[i]});
  while (play_operators.size() > wire::kMaxPlays) merge_nearest(play_operators);
  wire::Hysteresis inverse;
  double sum = hysteresis.weights.at(0);
  double moved_v = 0, last_v = 0;  // r' so far
  inverse.straight = static_cast<float>(1 / sum);
  for (const Play& play : play_operators) {
    moved_v += sum * (play.threshold_v - last_v);
    last_v = play.threshold_v;
    const double next = sum + play.weight;
    inverse.play_operators[inverse.count++] = {static_cast<float>(moved_v),
                                               static_cast<float>(-play.weight / (sum * next))};
    sum = next;
  }
  return inverse;
}

wire::Section pole_lead(double pole_hz, double rate_hz) {
  const double a = kept_in_a_tick(pole_hz, rate_hz);
  return {static_cast<float>(1 / (1 - a)), static_cast<float>(-a / (1 - a)), 0, 0, 0};
}

std::vector<double> played_through(const schema::Hysteresis& hysteresis, std::span<const double> drive_v) {
  std::vector<double> play_operators(hysteresis.weights.size()), out;
  out.reserve(drive_v.size());
  for (const double v : drive_v) out.push_back(moved_plays(hysteresis, v, play_operators));
  return out;
}

LinearDrive::LinearDrive(const schema::Hysteresis& hysteresis, double pole_hz, double rate_hz)
    : hysteresis_(hysteresis), plays_(hysteresis.weights.size()), kept_(kept_in_a_tick(pole_hz, rate_hz)) {}

double LinearDrive::operator()(double drive_v) {
  charge_v_ = kept_ * charge_v_ + (1 - kept_) * drive_v;
  const double v = moved_plays(hysteresis_, charge_v_, plays_);
  return (v - kept_ * std::exchange(last_v_, v)) / (1 - kept_);
}

std::vector<double> linear_drive_of(const std::vector<double>& drive_v, const schema::Hysteresis& hysteresis,
                                    double pole_hz, double rate_hz) {
  LinearDrive linear(hysteresis, pole_hz, rate_hz);
  std::vector<double> all;
  all.reserve(drive_v.size());
  for (const double v : drive_v) all.push_back(linear(v));
  return all;
}

}  // namespace tacto::playback
