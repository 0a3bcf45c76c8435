// SPDX-License-Identifier: GPL-3.0-or-later
#include "capture/import/uniform_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace tacto::capture {
namespace {

using schema::ErrorKind;
using schema::fail;
using schema::Result;

// The leading bits of a step: the exponent and six bits of the mantissa, so a bin is 1/64 wide.
constexpr int kDroppedTimes = 46;

double whole_where_close(double rate_hz) {
  const double whole = std::round(rate_hz);
  return std::abs(rate_hz - whole) <= 1e-9 * rate_hz ? whole : rate_hz;
}

tl::unexpected<schema::Error> uneven(double step, double period, const std::string& where) {
  return fail(
      ErrorKind::malformed,
      fmt::format("the time step of {:.6g} s is not a whole number of periods of {:.6g} s (within {:g})",
                  step, period, kMostJitter),
      where, "resample it evenly in the program that made it, or give --rate instead of --time-column");
}

}  // namespace

inline void ClockFinder::Bin::add(double step) {
  smallest = count == 0 ? step : std::min(smallest, step);
  largest = count == 0 ? step : std::max(largest, step);
  sum += step;
  ++count;
}

void ClockFinder::Bin::add(const Bin& other) {
  if (other.count == 0) return;
  smallest = count == 0 ? other.smallest : std::min(smallest, other.smallest);
  largest = count == 0 ? other.largest : std::max(largest, other.largest);
  sum += other.sum;
  count += other.count;
}

// In nearly every file the steps of one bin are consecutive, so the map is accessed only when the bin
// changes.
void ClockFinder::survey(std::span<const double> time_s) {
  Bin run;
  std::uint64_t run_key = 0;
  for (const double time : time_s) {
    const double step = time - std::exchange(last_s_, time);
    if (count_++ == 0) {
      first_s_ = time;
      continue;
    }
    not_increasing_ = not_increasing_ || !(step > 0);
    const std::uint64_t key = std::bit_cast<std::uint64_t>(step) >> kDroppedTimes;
    if (key != run_key) {
      if (run.count > 0) bins_[run_key].add(run);
      run = {};
      run_key = key;
    }
    run.add(step);
  }
  if (run.count > 0) bins_[run_key].add(run);
}

double ClockFinder::median_step() const {
  std::uint64_t below = 0;
  for (const auto& [key, bin] : bins_) {
    below += bin.count;
    if (below > (count_ - 1) / 2) return bin.sum / static_cast<double>(bin.count);
  }
  return 0;
}

// The median would be wrong: printed times at 3 kHz have steps of 0.3, 0.3 and 0.4 ms, and only their mean is
// the period.
double ClockFinder::find_period() const {
  const double median = median_step();
  double sum = 0;
  std::uint64_t count = 0;
  for (const auto& [key, bin] : bins_) {
    if (std::abs(bin.sum / static_cast<double>(bin.count) - median) > median / 2) continue;
    sum += bin.sum;
    count += bin.count;
  }
  return sum / static_cast<double>(count);
}

bool ClockFinder::is_one_tick(double step) const {
  return std::abs(step / period_s_ - 1) <= kMostJitter;
}

Result<void> ClockFinder::end_survey(const std::string& file) {
  if (count_ < 3)
    return fail(ErrorKind::malformed, "has too few rows to compute a rate from their times", file);
  if (not_increasing_) return {};
  period_s_ = find_period();
  for (const auto& [key, bin] : bins_)
    uneven_ = uneven_ || !is_one_tick(bin.smallest) || !is_one_tick(bin.largest);
  return {};
}

// Counts it, too.
bool ClockFinder::is_pause(double step) {
  if (!pauses_allowed_ || step <= 1.5 * period_s_) return false;
  pauses_s_ += step, pauses_ticks_ += std::round(step / period_s_);
  return ++pauses_ <= 1 + count_ / 1000;
}

Result<void> ClockFinder::locate_step(double step, std::uint64_t row, const PlaceOf& place_of,
                                      const std::string& file) {
  const double ticks = std::max(1.0, std::round(step / period_s_));
  if (!(ticks <= kLongestGap_samples))
    return fail(ErrorKind::malformed,
                fmt::format("the time jumps by {:.6g} s: at most {:g} samples may be missing", step,
                            kLongestGap_samples),
                fmt::format("{}: {}", file, place_of(row)), "import the part before or after it");
  if (std::abs(step / period_s_ - ticks) > kMostJitter && !is_pause(step))
    return uneven(step, period_s_, fmt::format("{}: {}", file, place_of(row)));
  const auto missing = static_cast<std::uint64_t>(ticks) - 1;
  if (missing > 0) gaps_.push_back({row, row + missing_ + missing, missing});
  missing_ += missing;
  return {};
}

Result<void> ClockFinder::locate(std::span<const double> time_s, const PlaceOf& place_of,
                                 const std::string& file) {
  for (const double time : time_s) {
    const std::uint64_t row = located_++;
    const double before = std::exchange(previous_s_, time);
    if (row == 0) continue;
    if (!(time > before))
      return fail(ErrorKind::malformed,
                  fmt::format("time goes from {} s to {} s: it must increase", before, time),
                  fmt::format("{}: {}", file, place_of(row)),
                  "if the rows are samples at an even rate, give --rate instead of --time-column; otherwise "
                  "remove the row");
    if (not_increasing_) continue;
    if (const auto fits = locate_step(time - before, row, place_of, file); !fits) return fits;
  }
  return {};
}

UniformClock ClockFinder::clock() const {
  const double ticks = static_cast<double>(count_ - 1 + missing_) - pauses_ticks_;
  return {whole_where_close(ticks / (last_s_ - first_s_ - pauses_s_)), gaps_};
}

}  // namespace tacto::capture
