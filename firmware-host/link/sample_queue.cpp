// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware-host/link/sample_queue.hpp"

#include <algorithm>

namespace tacto::firmware_host {

void SampleQueue::begin(std::size_t channels) {
  *this = {};
  channels_ = std::max<std::size_t>(channels, 1);
}

void SampleQueue::note_gap(std::uint64_t first_frame) {
  if (first_frame <= next_frame_) return;
  const std::uint64_t missing = first_frame - next_frame_;
  gaps_.push_back({pushed_, first_frame, missing});
  lost_ += missing;
  next_frame_ = first_frame;
}

void SampleQueue::push(const wire::Samples& samples) {
  if (samples.channels != channels_) return;
  const std::uint64_t end = samples.first_frame + samples.count;
  if (end <= next_frame_) return;
  note_gap(samples.first_frame);
  const std::size_t known = next_frame_ - samples.first_frame;
  const std::span<const std::int32_t> codes(samples.codes, samples.count * channels_);
  codes_.insert(codes_.end(), codes.begin() + known * channels_, codes.end());
  pushed_ += end - next_frame_;
  next_frame_ = end;
}

std::size_t SampleQueue::frames() const {
  const std::uint64_t end = gaps_.empty() ? pushed_ : gaps_.front().frame;
  return end - taken_;
}

schema::Gap SampleQueue::take_gap() {
  const schema::Gap gap = gaps_.front();
  gaps_.pop_front();
  return gap;
}

std::size_t SampleQueue::take(std::span<std::int32_t> interleaved) {
  const std::size_t count = std::min(frames(), interleaved.size() / channels_);
  std::copy_n(codes_.begin() + used_, count * channels_, interleaved.begin());
  used_ += count * channels_;
  taken_ += count;
  compact();
  return count;
}

// Moves the remaining codes to the front when they are less than half.
void SampleQueue::compact() {
  if (used_ * 2 < codes_.size()) return;
  codes_.erase(codes_.begin(), codes_.begin() + used_);
  used_ = 0;
}

}  // namespace tacto::firmware_host
