// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/block_zero_phase.hpp"

#include <algorithm>

namespace tacto::spatial {
namespace {

constexpr double kFaded = 1e-15;
constexpr std::size_t kLeastBlock = 65536;

}  // namespace

BlockZeroPhase::BlockZeroPhase(std::span<const Section> sections, std::size_t padding)
    : forwards_(sections),
      backwards_(sections),
      most_padding_(padding),
      fading_(forwards_.memory(kFaded)),
      block_(std::max(kLeastBlock, 4 * fading_)) {}

void BlockZeroPhase::reset() {
  held_.clear();
  ahead_.clear();
  begun_ = false;
}

// The same continuation before the record as extend_odd().
void BlockZeroPhase::begin(std::size_t padding) {
  padding_ = to_skip_ = padding;
  begun_ = true;
  std::vector<double> extended;
  for (std::size_t k = padding; k >= 1; --k) extended.push_back(2 * held_.front() - held_[k]);
  extended.insert(extended.end(), held_.begin(), held_.end());
  forwards_.settle(extended.front());
  append(extended);
}

void BlockZeroPhase::append(std::span<const double> values) {
  ahead_.insert(ahead_.end(), values.begin(), values.end());
  forwards_.run(std::span(ahead_).last(values.size()));
}

// Runs backwards over the first `seen` values ahead and appends `size` of them to `out`.
void BlockZeroPhase::run_block(std::size_t size, std::size_t seen, std::vector<double>& out) {
  scratch_.assign(ahead_.begin(), ahead_.begin() + static_cast<std::ptrdiff_t>(seen));
  backwards_.settle(scratch_.back());
  backwards_.run_backwards(scratch_);
  const std::size_t skipped = std::min(to_skip_, size);
  to_skip_ -= skipped;
  out.insert(out.end(), scratch_.begin() + static_cast<std::ptrdiff_t>(skipped),
             scratch_.begin() + static_cast<std::ptrdiff_t>(size));
  ahead_.erase(ahead_.begin(), ahead_.begin() + static_cast<std::ptrdiff_t>(size));
}

void BlockZeroPhase::push(std::span<const double> values, std::vector<double>& out) {
  while (!values.empty()) {
    // Blocks end at the same places for chunks of any size.
    const auto chunk = values.first(std::min(values.size(), block_ + fading_ - ahead_.size()));
    values = values.subspan(chunk.size());
    held_.insert(held_.end(), chunk.begin(), chunk.end());
    if (begun_)
      append(chunk);
    else if (held_.size() > most_padding_)
      begin(most_padding_);
    while (ahead_.size() >= block_ + fading_) run_block(block_, block_ + fading_, out);
    if (begun_ && held_.size() > 2 * (most_padding_ + 1))
      held_.erase(held_.begin(), held_.end() - static_cast<std::ptrdiff_t>(most_padding_ + 1));
  }
}

void BlockZeroPhase::finish(std::vector<double>& out) {
  if (held_.empty()) return;
  if (!begun_) begin(held_.size() - 1);
  std::vector<double> beyond;
  for (std::size_t k = 1; k <= padding_; ++k)
    beyond.push_back(2 * held_.back() - held_[held_.size() - 1 - k]);
  append(beyond);
  run_block(ahead_.size() - padding_, ahead_.size(), out);
  reset();
}

}  // namespace tacto::spatial
