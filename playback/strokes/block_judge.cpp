// SPDX-License-Identifier: GPL-3.0-or-later
#include "playback/strokes/block_judge.hpp"

#include <algorithm>
#include <cmath>

#include "playback/render/reference/exact_target.hpp"

namespace tacto::playback {
namespace {

constexpr double kRingsS = 0.3;                                // a period of the lower edge's skirt, 3 Hz
constexpr double kRestS = 0.05;                                // around the playback, with the tray at rest
constexpr double kShiftAroundS = 2e-3;                         // twice the greatest shift
constexpr std::uint64_t kMostFilled = std::uint64_t{1} << 22;  // frames; limits the numbers of a damaged file

double time_of(const JudgedRow& row) {
  return row.row.device_time_s;
}

// Rows closer to missing samples than the ringing of the filter are unknown.
void forget_near(const std::pair<double, double>& missing_s, std::span<const JudgedRow> rows,
                 std::vector<bool>& known) {
  const auto from = std::ranges::lower_bound(rows, missing_s.first - kRingsS, {}, time_of);
  const auto to = std::ranges::upper_bound(rows, missing_s.second + kRingsS, {}, time_of);
  for (auto row = from; row < to; ++row) known[static_cast<std::size_t>(row - rows.begin())] = false;
}

// The index of the frame at each row's time, linear between frames and constant beside them.
std::vector<double> frames_at(std::span<const JudgedRow> rows, const std::vector<double>& time_s) {
  std::vector<double> at(rows.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double t = time_of(rows[i]);
    while (next < time_s.size() && time_s[next] <= t) ++next;
    const auto before = static_cast<double>(next) - 1;
    at[i] = next == 0               ? 0
            : next == time_s.size() ? before
                                    : before + (t - time_s[next - 1]) / (time_s[next] - time_s[next - 1]);
  }
  return at;
}

constexpr double kMostBlockRows = 1 << 19;  // at any rate

}  // namespace

std::optional<ShiftedRow> MeasuredSection::at(std::size_t row) const {
  if (!known_[row]) return std::nullopt;
  return shifted_row(fine_m_, fine_rate_hz_, at_fine_[row]);
}

std::optional<MeasuredReader> MeasuredReader::open(const SessionOverview& overview) {
  if (!overview.header.sensor) return std::nullopt;
  return MeasuredReader(overview);
}

MeasuredReader::Filled MeasuredReader::filled(double from_s, double to_s) const {
  Filled all;
  const auto add = [&](double time_s, double displacement_m) {
    all.time_s.push_back(time_s);
    all.displacement_m.push_back(displacement_m);
  };
  const SensorFrame* before = nullptr;
  for (const SensorFrame& frame : samples_.frames()) {
    const std::uint64_t steps = before == nullptr ? 1 : frame.number - before->number;
    if (steps > kMostFilled) return {};
    if (steps > 1) all.missing_s.emplace_back(before->time_s, frame.time_s);
    for (std::uint64_t i = 1; i < steps; ++i) {
      const double u = static_cast<double>(i) / static_cast<double>(steps);
      add(std::lerp(before->time_s, frame.time_s, u),
          std::lerp(before->displacement_m, frame.displacement_m, u));
    }
    add(frame.time_s, frame.displacement_m);
    before = &frame;
    if (frame.time_s > to_s) break;
  }
  if (all.time_s.empty()) return all;
  if (all.time_s.front() > from_s + kRestS) all.missing_s.emplace_back(from_s, all.time_s.front());
  if (all.time_s.back() < to_s - kRestS) all.missing_s.emplace_back(all.time_s.back(), to_s);
  return all;
}

MeasuredSection MeasuredReader::in(std::span<const JudgedRow> rows) {
  const double from_s = time_of(rows.front()), to_s = time_of(rows.back());
  samples_.read_to(to_s + kShiftAroundS);
  samples_.forget_before(from_s - kShiftAroundS);
  const Filled frames = filled(from_s, to_s + kShiftAroundS);
  MeasuredSection section;
  section.known_.assign(rows.size(), samples_.sound() && frames.time_s.size() > 1);
  if (frames.time_s.size() < 2) return section;
  for (const auto& missing_s : frames.missing_s) forget_near(missing_s, rows, section.known_);
  const double rate_hz = header_.sensor->rate_hz;
  const spatial::Band band{header_.low_hz, header_.high_hz};
  Rests rests;  // where the tray is at rest
  if (begins_at_rest(rows)) rests.start = frames.displacement_m.front();
  if (ends_at_rest(rows)) rests.end = frames.displacement_m.back();
  ReadingGrid grid = reading_grid(static_cast<double>(frames.time_s.size() - 1) / rate_hz, rate_hz, band, 0);
  grid.samples = frames.time_s.size();
  const auto between = static_cast<std::size_t>(std::ceil(kReadingsAPeriod * band.high_hz / rate_hz));
  section.fine_m_ = signal_of(target_of_readings(frames.displacement_m, grid, band, 0, rests), between);
  section.fine_rate_hz_ = rate_hz * static_cast<double>(between);
  section.at_fine_ = frames_at(rows, frames.time_s);
  for (double& at : section.at_fine_) at *= static_cast<double>(between);
  return section;
}

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
