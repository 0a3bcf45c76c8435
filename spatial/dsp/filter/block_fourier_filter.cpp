// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/dsp/filter/block_fourier_filter.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <deque>
#include <mutex>
#include <utility>

#include "spatial/dsp/filter/band_kernel.hpp"
#include "spatial/dsp/filter/record_ends.hpp"
#include "spatial/dsp/fourier/fft.hpp"
#include "spatial/dsp/resample/rate_chain.hpp"

namespace tacto::spatial {
namespace {

constexpr std::size_t kLongestReach = 32768;
// The ends of a record are treated for the lowest frequency, but for none below this share of the highest.
constexpr double kLowestTreated = 1.0 / 512;
// With a gain the kernel is longer by this factor, for the gain's impulse response.
constexpr double kRoomForGain = 1.25;
constexpr std::size_t kFrame = 8192, kFewestPerFrame = 64;
constexpr double kNothing = 1e-9;
// More values than any record has.
constexpr double kEndless = 1e15;

double lowest_treated(Band band, double sample_rate_hz) {
  return std::max(band.low_hz, kLowestTreated * std::min(band.high_hz, sample_rate_hz / 2));
}

std::size_t reach_of(double low_hz, double rate_hz) {
  if (low_hz <= 0) return kLongestReach / 2;
  const double samples = std::ceil(kBandKernelPeriods / low_hz * rate_hz);
  return static_cast<std::size_t>(std::clamp(samples, 1.0, static_cast<double>(kLongestReach)));
}

// Blocks about as long as the kernel; longer blocks cost the same per value.
std::size_t block_length(std::size_t reach, std::size_t longest) {
  const std::size_t usual = std::bit_ceil(std::max<std::size_t>(7 * reach / 2, 1024));
  const bool shorter = longest < usual - 2 * reach;
  return shorter ? fast_length(longest + 2 * reach) : usual;
}

// Tapers the gain's impulse response beyond the kernel down to zero, and omits the rest.
std::vector<double> shortened(std::vector<double> circle, std::size_t reach, std::size_t longer) {
  const std::size_t length = circle.size();
  for (std::size_t k = reach; k <= length - reach; ++k) {
    const std::size_t distance = std::min(k, length - k);
    const double beyond = static_cast<double>(distance - reach) / static_cast<double>(longer - reach);
    circle[k] *= distance >= longer ? 0 : kernel_window(kFlatShare + (1 - kFlatShare) * beyond);
  }
  return circle;
}

// A kernel as the spectrum of its circular form: tap n at index n, tap -n at length - n.
struct KernelSpectrum {
  std::vector<std::complex<double>> bins;  // length / 2 + 1
  std::size_t length, reach;               // taps -reach ... reach, 2 reach < length
};

// The spectrum of a symmetric kernel, taps 0 ... reach.
KernelSpectrum kernel_spectrum(std::span<const double> taps, std::size_t length) {
  assert(!taps.empty() && 2 * (taps.size() - 1) < length);
  std::vector<double> circle(length, 0.0);
  for (std::size_t k = 0; k < taps.size(); ++k) circle[k] = circle[(length - k) % length] = taps[k];
  RealFft fft(length);
  KernelSpectrum kernel{std::vector<std::complex<double>>(fft.bins()), length, taps.size() - 1};
  fft.forward(circle, kernel.bins);
  return kernel;
}

// Convolution of an endless signal with a long kernel, in blocks of Fourier transforms (Stockham 1966).
class OverlapSave {
 public:
  using Sink = std::function<void(std::span<const double>)>;
  explicit OverlapSave(KernelSpectrum kernel)
      : kernel_(std::move(kernel)),
        fft_(kernel_.length),
        block_(kernel_.length),
        result_(kernel_.length),
        spectrum_(kernel_.bins.size()) {
    reset();
  }

  // Continues the signal, which was 0 before its first value. `sink` receives the values of the convolution
  // at the signal's own indices, in order and as soon as they are known.
  void push(std::span<const double> values, const Sink& sink) {
    while (!values.empty()) {
      const std::size_t size = std::min(values.size(), kernel_.length - filled_);
      std::ranges::copy(values.first(size), block_.begin() + static_cast<std::ptrdiff_t>(filled_));
      filled_ += size;
      values = values.subspan(size);
      if (filled_ == kernel_.length) run_block(hop(), sink);
    }
  }

  // The signal continues with a constant `level`; outputs values until there are `count` since the start.
  // Then the object is ready for the next signal.
  void finish(double level, std::size_t count, const Sink& sink) {
    while (given_ < count) {
      std::fill(block_.begin() + static_cast<std::ptrdiff_t>(filled_), block_.end(), level);
      run_block(std::min(hop(), count - given_), sink);
    }
    reset();
  }

  // A block begins `reach` before the first value of its output.
  void reset() {
    std::ranges::fill(block_, 0.0);
    filled_ = kernel_.reach;
    given_ = 0;
  }

 private:
  std::size_t hop() const { return kernel_.length - 2 * kernel_.reach; }
  void run_block(std::size_t target, const Sink& sink) {
    fft_.forward(block_, spectrum_);
    for (std::size_t k = 0; k < spectrum_.size(); ++k) spectrum_[k] *= kernel_.bins[k];
    fft_.inverse(spectrum_, result_);
    given_ += target;
    sink(std::span(result_).subspan(kernel_.reach, target));
    std::copy(block_.begin() + static_cast<std::ptrdiff_t>(hop()), block_.end(), block_.begin());
    filled_ = 2 * kernel_.reach;
  }

  KernelSpectrum kernel_;
  RealFft fft_;
  std::vector<double> block_, result_;
  std::vector<std::complex<double>> spectrum_;
  std::size_t filled_ = 0, given_ = 0;
};

KernelSpectrum with_gain(KernelSpectrum kernel, double rate_hz, const SpectralGain& gain) {
  const double bin_hz = rate_hz / static_cast<double>(kernel.length);
  for (std::size_t k = 0; k < kernel.bins.size(); ++k)
    if (std::abs(kernel.bins[k]) > kNothing) kernel.bins[k] *= gain(static_cast<double>(k) * bin_hz);
  RealFft fft(kernel.length);
  std::vector<double> circle(kernel.length);
  fft.inverse(kernel.bins, circle);
  const auto longer = static_cast<std::size_t>(kRoomForGain * static_cast<double>(kernel.reach)) + 1;
  fft.forward(shortened(std::move(circle), kernel.reach, longer), kernel.bins);
  kernel.reach = longer;
  return kernel;
}

// The parameters of a band's kernel; equal parameters give the same kernel to the bit.
struct KernelDesign {
  double low_hz, high_hz, rate_hz;
  std::size_t reach, length;
  bool operator==(const KernelDesign&) const = default;
};

// Caches the last kernels, because a folder of recordings needs the same band and rate many times.
KernelSpectrum band_spectrum(const KernelDesign& target) {
  constexpr std::size_t kMost = 4, kLongest = std::size_t{1} << 17;  // 1 MB each
  static std::mutex mutex;
  static std::deque<std::pair<KernelDesign, KernelSpectrum>> recent;
  {
    const std::lock_guard lock(mutex);
    for (const auto& [design, kernel] : recent)
      if (design == target) return kernel;
  }
  KernelSpectrum made = kernel_spectrum(
      band_kernel({target.low_hz, target.high_hz}, target.rate_hz, target.reach), target.length);
  if (target.length > kLongest) return made;
  const std::lock_guard lock(mutex);
  recent.emplace_front(target, made);
  if (recent.size() > kMost) recent.pop_back();
  return made;
}

KernelSpectrum design(Band band, double rate_hz, const SpectralGain& gain, std::size_t longest) {
  const std::size_t reach = reach_of(band.low_hz, rate_hz);
  const auto room = static_cast<std::size_t>(kRoomForGain * static_cast<double>(reach)) + 1;
  const std::size_t length = block_length(gain ? room : reach, longest);
  KernelSpectrum kernel = band_spectrum({band.low_hz, band.high_hz, rate_hz, reach, length});
  return gain ? with_gain(std::move(kernel), rate_hz, gain) : kernel;
}

}  // namespace

class BlockFourierFilter::State {
 public:
  State(double sample_rate_hz, Band band, const SpectralGain& gain, std::size_t longest)
      : extended_(lowest_treated(band, sample_rate_hz), sample_rate_hz),
        chain_(sample_rate_hz, band.high_hz),
        frame_(std::max(kFrame, kFewestPerFrame * chain_.factor())),
        convolution_(
            design(band, sample_rate_hz / factor(), gain, lower_count(longest, band, sample_rate_hz))),
        reach_s_(static_cast<double>(reach_of(band.low_hz, sample_rate_hz / factor())) * factor() /
                 sample_rate_hz),
        level_gain_(band.low_hz > 0 ? 0
                    : gain          ? gain(0).real()
                                    : 1) {
    reset();
  }

  double reach_s() const { return reach_s_; }

  void push(std::span<const double> values, std::vector<double>& out) {
    taken_ += values.size();
    if (!values.empty()) first_ = taken_ == values.size() ? values.front() : first_;
    while (!values.empty()) {
      const auto chunk = values.first(std::min(values.size(), frame_));
      extended_.push(chunk, waiting_);
      run_frames(out);
      values = values.subspan(chunk.size());
    }
  }

  void finish(std::vector<double>& out) {
    if (taken_ == 1) out.push_back(level_gain_ * first_);
    if (taken_ > 1) finish_record(out);
    reset();
  }

  void reset() {
    extended_.reset();
    chain_.reset();
    convolution_.reset();
    waiting_.assign(lead(), 0.0);
    taken_ = passed_ = 0;
  }

 private:
  double factor() const { return static_cast<double>(chain_.factor()); }
  // Zeros before the record that fill the memory of the chain, so that its state is defined.
  std::size_t lead() const { return chain_.memory() / chain_.factor() * chain_.factor(); }
  // Number of output values before the first of the record.
  std::size_t late() const { return lead() + chain_.delay() + extended_.padding(); }

  // Number of values at the lower rate for the longest record and its continuation beyond the ends.
  std::size_t lower_count(std::size_t longest, Band band, double sample_rate_hz) const {
    const EndTreatment ends = EndTreatment::for_lowest(lowest_treated(band, sample_rate_hz), sample_rate_hz,
                                                       std::max<std::size_t>(longest, 2));
    const double beyond = 2 * static_cast<double>(ends.padding) + 4 * static_cast<double>(chain_.memory());
    const double lower = (static_cast<double>(longest) + beyond) / factor() + 1;
    return lower < kEndless ? static_cast<std::size_t>(lower) : longest;
  }

  void run_frames(std::vector<double>& out) {
    std::size_t begin = 0;
    for (; waiting_.size() - begin >= frame_; begin += frame_)
      convolution_.push(chain_.down(std::span(waiting_).subspan(begin, frame_)), sink_to(out));
    if (begin > 0) waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(begin));
  }

  OverlapSave::Sink sink_to(std::vector<double>& out) {
    return [this, &out](std::span<const double> lower) {
      const std::size_t most = frame_ / chain_.factor();
      for (; !lower.empty(); lower = lower.subspan(std::min(most, lower.size())))
        give(chain_.up(lower.first(std::min(most, lower.size()))), out);
    };
  }

  // Omits what is before the record and beyond its end.
  void give(std::span<const double> values, std::vector<double>& out) {
    const std::size_t begin = passed_, end = passed_ + values.size();
    passed_ = end;
    const std::size_t from = std::clamp(late(), begin, end), to = std::clamp(late() + taken_, begin, end);
    const double level = level_gain_ * extended_.start_level();
    const auto target = values.subspan(from - begin, to - from);
    out.insert(out.end(), target.begin(), target.end());
    if (level != 0)
      for (double& value : std::span(out).last(target.size())) value += level;
  }

  // After its end the record has a constant level. When the chain's memory holds only that level, its
  // output at the lower rate is that level, too.
  void finish_record(std::vector<double>& out) {
    extended_.finish(waiting_);
    const std::size_t size = waiting_.size() + chain_.memory();
    waiting_.resize((size + frame_ - 1) / frame_ * frame_, extended_.final_value());
    run_frames(out);
    const std::size_t needed = (late() + taken_ + chain_.factor() - 1) / chain_.factor();
    convolution_.finish(extended_.final_value(), needed, sink_to(out));
  }

  ExtendedRecord extended_;
  RateChain chain_;
  std::size_t frame_;
  OverlapSave convolution_;
  double reach_s_;
  double level_gain_;  // gain of a record's level, which is subtracted first
  std::vector<double> waiting_;
  std::size_t taken_ = 0, passed_ = 0;
  double first_ = 0;
};

BlockFourierFilter::BlockFourierFilter(double sample_rate_hz, Band band, const SpectralGain& gain,
                                       std::size_t longest)
    : state_(std::make_unique<State>(sample_rate_hz, band, gain, longest)) {
  assert(sample_rate_hz > 0 && band.low_hz >= 0 && band.low_hz < band.high_hz);
}
BlockFourierFilter::BlockFourierFilter(BlockFourierFilter&&) noexcept = default;
BlockFourierFilter& BlockFourierFilter::operator=(BlockFourierFilter&&) noexcept = default;
BlockFourierFilter::~BlockFourierFilter() = default;

void BlockFourierFilter::push(std::span<const double> values, std::vector<double>& out) {
  state_->push(values, out);
}

void BlockFourierFilter::finish(std::vector<double>& out) {
  state_->finish(out);
}

void BlockFourierFilter::reset() {
  state_->reset();
}

double BlockFourierFilter::reach_s() const {
  return state_->reach_s();
}

}  // namespace tacto::spatial
