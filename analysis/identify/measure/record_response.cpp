// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/identify/measure/record_response.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numeric>

#include "analysis/identify/measure/response_estimate.hpp"
#include "spatial/dsp/fourier/fft.hpp"

namespace tacto::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using schema::ErrorKind;
using schema::fail;
using schema::Result;

using RecordSpectrum = std::vector<std::complex<double>>;

constexpr std::size_t kMostPlaces = 80;
constexpr std::size_t kFewestSamples = 1024;
constexpr double kHalfWidthHz = 0.5;
constexpr double kUndriven = 1e-6;  // of the strongest bin's power
constexpr double kMostNoise = 0.2;  // of the response; a response has at least five standard deviations
constexpr double kOwnNoise = 4;     // times the neighbours' noise, as at a line of the mains
constexpr double kShows = 2;        // standard deviations of chi squared

struct RecordSpectra {
  RecordSpectrum input, output;
  double bin_hz = 0;
  std::size_t half = 0;  // bins to each side of a place
};

RecordSpectrum record_spectrum_of(std::span<const double> x) {
  const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  std::vector<double> centred(x.begin(), x.end());
  for (double& value : centred) value -= mean;
  spatial::RealFft transform(x.size());
  RecordSpectrum spectrum(transform.bins());
  transform.forward(centred, spectrum);
  return spectrum;
}

struct LocalResponse {
  std::complex<double> response;
  double offset = 0;  // of the result from the middle, bins; there the variance is least
  // Power of the residuals per bin, and its degrees of freedom (complex).
  double noise_power = 0, freedom = 0;
  // Variance of the real part, and of the imaginary part, of the response for noise of power 1 per bin.
  double variance_for_one = 0;
};

constexpr std::size_t kLeastLocalBins = 15;  // six unknowns, and nine bins for the noise

using Complex = std::complex<double>;

constexpr Index kLocalTerms = 3;                    // of a polynomial of second degree
constexpr double kLocalSingular = 1e-7;             // of the largest singular value; below: not determined
constexpr int kLocalPlaces = 20, kLocalRounds = 6;  // to each side of the best; to 1e-8

struct LocalTable {
  MatrixXcd columns;  // each of length 1
  Eigen::VectorXd lengths;
};

// Powers of the position from -1 to 1: multiplied by the input, and alone.
LocalTable local_table(std::span<const Complex> input, bool transient) {
  const auto count = static_cast<Index>(input.size());
  const double half = static_cast<double>(count - 1) / 2;
  LocalTable table{MatrixXcd(count, transient ? 2 * kLocalTerms : kLocalTerms), {}};
  for (Index row = 0; row < count; ++row) {
    double power = 1;
    for (Index term = 0; term < kLocalTerms; ++term, power *= (static_cast<double>(row) - half) / half) {
      table.columns(row, term) = power * input[static_cast<std::size_t>(row)];
      if (transient) table.columns(row, kLocalTerms + term) = power;
    }
  }
  table.lengths = table.columns.colwise().norm().transpose().cwiseMax(1e-300);
  for (Index i = 0; i < table.columns.cols(); ++i) table.columns.col(i) /= table.lengths(i);
  return table;
}

// The polynomial's terms at a position, scaled for the product with a solution of unit columns.
VectorXcd local_terms_at(const LocalTable& table, double place) {
  VectorXcd terms = VectorXcd::Zero(table.columns.cols());
  double power = 1;
  for (Index term = 0; term < kLocalTerms; ++term, power *= place) terms(term) = power / table.lengths(term);
  return terms;
}

// From -0.5 to 0.5. For a line between two bins the response is known only at the line, so the search is
// refined in rounds.
template <class Variance>
double best_place(const Variance& variance) {
  double best = 0, least = variance(0), step = 0.5 / kLocalPlaces;
  for (int round = 0; round < kLocalRounds; ++round, step /= kLocalPlaces) {
    const double middle = best;
    for (int i = -kLocalPlaces; i <= kLocalPlaces; ++i) {
      const double place = std::clamp(middle + step * i, -0.5, 0.5), here = variance(place);
      if (here < least) least = here, best = place;
    }
  }
  return best;
}

// Local polynomial method (Pintelon, Schoukens, Vandersteen and Barbe 2010): within these bins of the
// spectra of a whole record, Y = G U + T + noise. The response G and (if `transient`) the effect of the
// record's two ends, T, are polynomials of second degree in the frequency. Least squares by singular values.
// The result is given at the frequency of least variance, within half the bins of their middle: a line
// between two bins determines the response only at its own frequency. Error: of third degree in bins over
// the width of the response, in bins. Preconditions: equal numbers of input and output bins, odd, at least
// kLeastLocalBins.
LocalResponse local_response(std::span<const Complex> input, std::span<const Complex> output,
                             bool transient) {
  const LocalTable table = local_table(input, transient);
  const Eigen::Map<const VectorXcd> answer(output.data(), static_cast<Index>(output.size()));
  const Eigen::JacobiSVD<MatrixXcd> parts(table.columns, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::ArrayXd sizes = parts.singularValues().array();
  // Undetermined directions keep a large variance.
  const Eigen::ArrayXd damped = (sizes.square() + std::pow(kLocalSingular * sizes(0), 2)).inverse();
  const VectorXcd along = parts.matrixU().adjoint() * answer;
  const VectorXcd solution = parts.matrixV() * ((sizes * damped).cast<Complex>() * along.array()).matrix();
  LocalResponse local;
  local.freedom = static_cast<double>(table.columns.rows() - table.columns.cols());
  local.noise_power = (answer - table.columns * solution).squaredNorm() / local.freedom;
  const auto variance = [&](double place) {
    return (parts.matrixV().adjoint() * local_terms_at(table, place))
        .array()
        .abs2()
        .matrix()
        .dot(damped.matrix());
  };
  const double best = best_place(variance);
  local.response = local_terms_at(table, best).transpose() * solution;
  local.variance_for_one = variance(best) / 2;
  local.offset = best * static_cast<double>(input.size() - 1) / 2;
  return local;
}

RecordSpectra spectra_of(std::span<const double> input, std::span<const double> output, double rate_hz) {
  RecordSpectra spectra{record_spectrum_of(input), record_spectrum_of(output),
                        rate_hz / static_cast<double>(input.size()), (kLeastLocalBins - 1) / 2};
  spectra.half = std::max(spectra.half, static_cast<std::size_t>(std::round(kHalfWidthHz / spectra.bin_hz)));
  return spectra;
}

// The strongest bin of each part of the band; the ranges of bins around them do not overlap.
std::vector<std::size_t> places_in(const RecordSpectra& spectra, double low_hz, double high_hz) {
  std::vector<std::size_t> places;
  std::size_t next = spectra.half + 1;
  const auto bin_at = [&](double part) {
    return static_cast<std::size_t>(std::round(low_hz * std::pow(high_hz / low_hz, part) / spectra.bin_hz));
  };
  for (std::size_t i = 0; i < kMostPlaces; ++i) {
    const double slot = static_cast<double>(i), slots = kMostPlaces - 1;
    const std::size_t first = std::max(next, bin_at(std::max(0.0, (slot - 0.5) / slots)));
    const std::size_t end = bin_at(std::min(1.0, (slot + 0.5) / slots)) + 1;
    if (first >= end || end + spectra.half >= spectra.input.size()) continue;
    const auto from = spectra.input.begin() + static_cast<std::ptrdiff_t>(first),
               to = spectra.input.begin() + static_cast<std::ptrdiff_t>(end);
    const auto strongest = std::ranges::max_element(from, to, {}, [](auto u) { return std::norm(u); });
    places.push_back(static_cast<std::size_t>(strongest - spectra.input.begin()));
    next = places.back() + 2 * spectra.half + 1;
  }
  double most = 0;
  for (const std::size_t at : places) most = std::max(most, std::norm(spectra.input[at]));
  std::erase_if(places, [&](std::size_t at) { return std::norm(spectra.input[at]) < kUndriven * most; });
  return places;
}

std::vector<LocalResponse> responses_at(const RecordSpectra& spectra, std::span<const std::size_t> places,
                                        bool transient) {
  std::vector<LocalResponse> list;
  const std::size_t count = 2 * spectra.half + 1;
  for (const std::size_t at : places)
    list.push_back(local_response(std::span(spectra.input).subspan(at - spectra.half, count),
                                  std::span(spectra.output).subspan(at - spectra.half, count), transient));
  return list;
}

std::vector<double> noise_powers(std::span<const LocalResponse> list) {
  std::vector<double> own, powers;
  for (const LocalResponse& local : list) own.push_back(local.noise_power);
  powers = mean_of_neighbours(own);
  for (std::size_t i = 0; i < own.size(); ++i)
    if (own[i] > kOwnNoise * powers[i]) powers[i] = own[i];
  return powers;
}

// Fewest degrees of freedom (real values) of a place's noise.
double freedom_of(std::span<const LocalResponse> list) {
  double fewest = INFINITY;
  for (const LocalResponse& local : list) fewest = std::min(fewest, 2 * local.freedom);
  return fewest * kFewestNeighbours;
}

// Whether the fit without the effect of the record's ends is worse than noise explains.
bool ends_show(std::span<const LocalResponse> with, std::span<const LocalResponse> without) {
  const std::vector<double> powers = noise_powers(with);
  double taken = 0, terms = 0;
  for (std::size_t i = 0; i < with.size(); ++i) {
    if (!(powers[i] > 0)) continue;
    taken +=
        (without[i].freedom * without[i].noise_power - with[i].freedom * with[i].noise_power) / powers[i];
    terms += without[i].freedom - with[i].freedom;
  }
  return taken > terms + kShows * std::sqrt(terms);
}

}  // namespace

Result<BodeData> response_of_record(std::span<const double> input, std::span<const double> output,
                                    double rate_hz, double low_hz, double high_hz,
                                    const std::string& source) {
  if (input.size() < kFewestSamples)
    return fail(ErrorKind::unsuitable, "the recording is too short for a frequency response", source);
  const RecordSpectra spectra = spectra_of(input, output, rate_hz);
  const std::vector<std::size_t> places = places_in(spectra, low_hz, high_hz);
  std::vector<LocalResponse> list = responses_at(spectra, places, true);
  if (auto plain = responses_at(spectra, places, false); !ends_show(list, plain)) list = std::move(plain);
  const std::vector<double> powers = noise_powers(list);
  BodeData data;
  data.source = source;
  data.noise_freedom = freedom_of(list);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const double noise = noise_no_less(std::sqrt(powers[i] * list[i].variance_for_one), list[i].response);
    if (!(noise < kMostNoise * std::abs(list[i].response))) continue;
    data.frequency_hz.push_back((static_cast<double>(places[i]) + list[i].offset) * spectra.bin_hz);
    data.response.push_back(list[i].response);
    data.noise.push_back(noise);
  }
  if (!data.frequency_hz.empty()) return data;
  return fail(ErrorKind::unsuitable, "output and input are not correlated", source,
              "name the channels with --input and --output-channel; slow loops need --method loop");
}

}  // namespace tacto::analysis
