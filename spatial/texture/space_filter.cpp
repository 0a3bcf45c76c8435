// SPDX-License-Identifier: GPL-3.0-or-later
#include "spatial/texture/space_filter.hpp"

#include <fmt/format.h>

namespace tacto::spatial {
namespace {

using schema::ErrorKind;

std::string per_mm(double per_m) {
  return fmt::format("{:g}/mm", per_m * 1e-3);
}

schema::Result<void> check(const SpaceFilter& filter, double pitch_m, std::size_t count) {
  const auto [method, low_per_m, high_per_m, edges, order] = filter;
  if (!(low_per_m >= 0 && low_per_m < high_per_m))
    return schema::fail(ErrorKind::unsuitable, fmt::format("the limits of the band {} to {} do not increase",
                                                           per_mm(low_per_m), per_mm(high_per_m)));
  if (high_per_m > 0.5 / pitch_m)
    return schema::fail(
        ErrorKind::unsuitable,
        fmt::format("the band ends at {}, but the grid at {}", per_mm(high_per_m), per_mm(0.5 / pitch_m)), {},
        "use a lower band, or a finer grid ('spatial' makes it with --grid)");
  if (static_cast<double>(count) * pitch_m * low_per_m < 1 && low_per_m > 0)
    return schema::fail(ErrorKind::unsuitable,
                        fmt::format("the texture of {:.4g} mm is shorter than one period of {}",
                                    static_cast<double>(count) * pitch_m * 1e3, per_mm(low_per_m)),
                        {}, "use a higher lower end of the band");
  return {};
}

// The kernels count in samples, so a rate per metre can replace one per second.
TimeFilter in_samples(const SpaceFilter& filter) {
  return {filter.method, {filter.low_per_m, filter.high_per_m}, filter.edges, filter.order};
}

}  // namespace

schema::KnownBand SpaceFilter::kept(double pitch_m) const {
  const Band band = in_samples(*this).kept(1 / pitch_m);
  return {band.low_hz, band.high_hz};
}

schema::Result<std::vector<double>> filter_in_space(std::span<const double> values, double pitch_m,
                                                    const SpaceFilter& filter) {
  if (filter.method != FilterMethod::none) TACTO_TRY(check(filter, pitch_m, values.size()));
  return filter_in_time(values, 1 / pitch_m, in_samples(filter));
}

}  // namespace tacto::spatial
