// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/stream_filter.hpp"

namespace tacto::spatial {
namespace {

class NoFilter : public StreamFilter {
 public:
  void push(std::span<const double> values, std::vector<double>& out) override {
    out.insert(out.end(), values.begin(), values.end());
  }
  void finish(std::vector<double>&) override {}
};

// Sees all before it gives the first.
class WholeFilter : public StreamFilter {
 public:
  WholeFilter(const TimeFilter& filter, double sample_rate_hz, SpectralGain equaliser)
      : filter_(filter), sample_rate_hz_(sample_rate_hz), equaliser_(std::move(equaliser)) {}
  void push(std::span<const double> values, std::vector<double>&) override {
    values_.insert(values_.end(), values.begin(), values.end());
  }
  void finish(std::vector<double>& out) override {
    const auto filtered = filter_in_time(values_, sample_rate_hz_, filter_, equaliser_);
    values_ = {};
    out.insert(out.end(), filtered->begin(), filtered->end());  // the filter was checked before
  }

 private:
  TimeFilter filter_;
  double sample_rate_hz_;
  SpectralGain equaliser_;
  std::vector<double> values_;
};

}  // namespace

std::unique_ptr<StreamFilter> stream_filter(const TimeFilter& filter, double sample_rate_hz,
                                            const SpectralGain& equaliser, std::size_t) {
  if (filter.method == FilterMethod::none && !equaliser) return std::make_unique<NoFilter>();
  return std::make_unique<WholeFilter>(filter, sample_rate_hz, equaliser);
}

}  // namespace tacto::spatial
