// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/fourier/fft.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cassert>
#include <deque>
#include <memory>
#include <mutex>
#include <utility>

#include "spatial/dsp/fourier/fftw_parts.hpp"

namespace tacto::spatial {
namespace {

void transform(std::span<double> values, GridSize size, fftw_r2r_kind kind) {
  assert(values.size() == size.columns * size.rows && !values.empty());
  const int rows = static_cast<int>(size.rows), columns = static_cast<int>(size.columns);
  std::unique_lock lock(planner_mutex());
  const fftw_plan plan =
      fftw_plan_r2r_2d(rows, columns, values.data(), values.data(), kind, kind, FFTW_ESTIMATE);
  lock.unlock();
  fftw_execute(plan);
  lock.lock();
  fftw_destroy_plan(plan);
}

struct PlanDeleter {
  void operator()(fftw_plan plan) const {
    const std::lock_guard lock(planner_mutex());
    fftw_destroy_plan(plan);
  }
};
using Plan = std::shared_ptr<std::remove_pointer_t<fftw_plan>>;

enum class Direction { to_spectrum, to_time };

// Caches the last plans, because planning computes tables of sines, which takes longer than a transform, and
// a folder of recordings needs few lengths. A plan can be used with any aligned buffers, from any thread.
class RecentPlans {
 public:
  Plan find(Direction direction, std::size_t length) {
    const auto target = [&](const Kept& kept) {
      return kept.direction == direction && kept.length == length;
    };
    const auto found = std::ranges::find_if(kept_, target);
    return found == kept_.end() ? nullptr : found->plan;
  }
  // Returns the plan that was removed: it must not be destroyed while the planner's lock is held.
  Plan keep(Direction direction, std::size_t length, const Plan& plan) {
    if (length > kLongest) return nullptr;
    kept_.push_front({direction, length, plan});
    if (kept_.size() <= kMost) return nullptr;
    Plan oldest = std::move(kept_.back().plan);
    kept_.pop_back();
    return oldest;
  }

 private:
  static constexpr std::size_t kMost = 16, kLongest = std::size_t{1} << 18;  // some 4 MB of tables each
  struct Kept {
    Direction direction;
    std::size_t length;
    Plan plan;
  };
  std::deque<Kept> kept_;
};

RecentPlans& recent_plans() {
  static RecentPlans& plans = *new RecentPlans;  // not destroyed: FFTW's tables may go first at exit
  return plans;
}

Plan planned(Direction direction, std::size_t length, double* time, fftw_complex* spectrum) {
  Plan plan, oldest;  // destroyed after the lock
  const std::lock_guard lock(planner_mutex());
  plan = recent_plans().find(direction, length);
  if (plan) return plan;
  const int n = static_cast<int>(length);
  plan.reset(direction == Direction::to_spectrum ? fftw_plan_dft_r2c_1d(n, time, spectrum, FFTW_ESTIMATE)
                                                 : fftw_plan_dft_c2r_1d(n, spectrum, time, FFTW_ESTIMATE),
             PlanDeleter());
  oldest = recent_plans().keep(direction, length, plan);
  return plan;
}

}  // namespace

// FFTW's sums have a factor of 2 for each axis.
void to_cosines(std::span<double> values, GridSize size) {
  transform(values, size, FFTW_REDFT10);
  for (double& value : values) value *= 0.25;
}

void from_cosines(std::span<double> values, GridSize size) {
  transform(values, size, FFTW_REDFT01);
  const double scale = 1 / static_cast<double>(values.size());
  for (double& value : values) value *= scale;
}

std::mutex& planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct RealFft::State {
  explicit State(std::size_t n)
      : length(n), time(aligned_buffer<double>(n)), spectrum(aligned_buffer<fftw_complex>(n / 2 + 1)) {}

  fftw_plan plan_forward() {
    if (!to_spectrum) to_spectrum = planned(Direction::to_spectrum, length, time.get(), spectrum.get());
    return to_spectrum.get();
  }

  fftw_plan plan_inverse() {
    if (!to_time) to_time = planned(Direction::to_time, length, time.get(), spectrum.get());
    return to_time.get();
  }

  std::size_t length;
  AlignedBuffer<double> time;
  AlignedBuffer<fftw_complex> spectrum;
  Plan to_spectrum, to_time;  // planned on first use, because most owners need one direction
};

RealFft::RealFft(std::size_t length) : state_(std::make_unique<State>(length)) {
  assert(length >= 1);
}
RealFft::RealFft(RealFft&&) noexcept = default;
RealFft& RealFft::operator=(RealFft&&) noexcept = default;
RealFft::~RealFft() = default;

std::size_t RealFft::length() const {
  return state_->length;
}

void RealFft::forward(std::span<const double> time, std::span<std::complex<double>> spectrum) {
  assert(time.size() == length() && spectrum.size() == bins());
  const fftw_plan plan = state_->plan_forward();
  std::ranges::copy(time, state_->time.get());
  fftw_execute_dft_r2c(plan, state_->time.get(), state_->spectrum.get());
  const auto* result = reinterpret_cast<const std::complex<double>*>(state_->spectrum.get());
  std::copy_n(result, bins(), spectrum.begin());
}

void RealFft::inverse(std::span<const std::complex<double>> spectrum, std::span<double> time) {
  assert(time.size() == length() && spectrum.size() == bins());
  const fftw_plan plan = state_->plan_inverse();
  std::ranges::copy(spectrum, reinterpret_cast<std::complex<double>*>(state_->spectrum.get()));
  fftw_execute_dft_c2r(plan, state_->spectrum.get(), state_->time.get());
  const double scale = 1 / static_cast<double>(length());
  std::transform(state_->time.get(), state_->time.get() + length(), time.begin(),
                 [scale](double value) { return value * scale; });
}

std::size_t fast_length(std::size_t n) {
  for (std::size_t candidate = std::max<std::size_t>(n, 1);; ++candidate) {
    std::size_t rest = candidate;
    for (const std::size_t factor : {2U, 3U, 5U, 7U})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return candidate;
  }
}

}  // namespace tacto::spatial
