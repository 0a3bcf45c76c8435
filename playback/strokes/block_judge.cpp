// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/strokes/block_judge.hpp"

#include <algorithm>
#include <cmath>

namespace tacto::playback {
namespace {

constexpr double kMostBlockRows = 1 << 19;  // at any rate

}  // namespace

std::size_t rows_in(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::clamp(std::ceil(seconds * rate_hz), 1.0, kMostBlockRows));
}

// Rows beyond a stop that is longer than the rows around a block have no influence on it.
BlockJudge::BlockJudge(const SessionOverview& overview, const JudgedBlocks& blocks,
                       std::function<void(const StrokeSums&)> found)
    : overview_(overview),
      block_rows_(rows_in(blocks.block_s, overview.header.rate_hz)),
      around_rows_(rows_in(blocks.around_s, overview.header.rate_hz)),
      maker_(overview, 2 * around_rows_),
      follower_(overview),
      target_(overview),
      measured_(MeasuredReader::open(overview)),
      strokes_(std::move(found)) {}

void BlockJudge::take(const schema::SessionTick& tick, std::optional<float> unlimited_v) {
  maker_.take(tick, [&](const SessionRow& row) {
    rows_.push_back(follower_.next(row, maker_.turns()));
    unlimited_v_.push_back(unlimited_v);
    if (rows_.size() == judged_ + block_rows_ + around_rows_) judge(block_rows_);
  });
}

void BlockJudge::finish(LastStroke last) {
  judge(rows_.size() - judged_);
  if (last == LastStroke::whole) strokes_.end();
}

void BlockJudge::judge(std::size_t rows) {
  const SessionTarget target = target_.target_in(rows_);
  const schema::SessionHeader& header = overview_.header;
  const auto between =
      static_cast<std::size_t>(std::ceil(kReadingsAPeriod * header.high_hz / header.rate_hz));
  const auto predicted_m = predicted_displacement_m(header, rows_, between);
  const auto measured = measured_ ? std::optional(measured_->in(rows_)) : std::nullopt;
  for (std::size_t i = judged_; i < judged_ + rows; ++i)
    strokes_.add({first_row_ + i, rows_[i].row, target.displacement_m[i], !target.unknown[i],
                  shifted_row(predicted_m, header.rate_hz * static_cast<double>(between),
                              static_cast<double>(i * between)),
                  measured ? measured->at(i) : std::nullopt, unlimited_v_[i]});
  judged_ += rows;
  const std::size_t done = judged_ - std::min(judged_, around_rows_);
  rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(done));
  unlimited_v_.erase(unlimited_v_.begin(), unlimited_v_.begin() + static_cast<std::ptrdiff_t>(done));
  judged_ -= done, first_row_ += done;
}

}  // namespace tacto::playback
