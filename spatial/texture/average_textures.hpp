// SPDX-License-Identifier: GPL-3.0-or-later
// The mean of several strokes over one place, and their standard deviation.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "data-schema/base/error.hpp"
#include "data-schema/texture/texture.hpp"

namespace tacto::spatial {

/// Input: textures one by one, of one recording or several. Holds only sums (24 bytes per sample of the
/// covered range).
class TextureAverager {
 public:
  /// Adds a texture that is on the common grid; `stroke` has the shift with which it was made. Errors:
  /// unsuitable, if its pitch, quantity or unit differ from the first one's, or if it is more than 10 lengths
  /// of the first away.
  schema::Result<void> add(const schema::Texture& texture, const schema::AveragedStroke& stroke);

  std::size_t strokes() const { return strokes_.size(); }
  /// The mean so far over the whole covered range, from first() pitches on the bench on.
  std::vector<double> mean() const;
  double first() const { return static_cast<double>(first_); }

  /// Mean and standard deviation (over n - 1) of the longest section that at least half of the strokes, and
  /// 2, cover. The valid band is the one common to all strokes there. Errors: unsuitable, for fewer than 2
  /// strokes, or if no 2 of them overlap.
  schema::Result<schema::Texture> finish(const std::string& align) const;

 private:
  struct Cell {
    double mean = 0, squares = 0;  // Welford 1962: sum of squared deviations
    std::int32_t count = 0;
  };
  struct Section {
    std::size_t begin = 0, end = 0;
  };
  // Different names in the order of their first use.
  struct Names {
    const std::string& with(const std::string& name, const char* between);
    std::set<std::string> seen;
    std::string list;
  };
  schema::Result<void> check(const schema::Texture& texture, std::int64_t first) const;
  void cover(std::int64_t first, std::size_t size);
  void narrow_band(const schema::Texture& texture);
  Section well_covered() const;
  std::vector<schema::StrokeCount> counts(Section section) const;
  std::vector<schema::BandPoint> band(double origin_m, double length_m) const;
  void keep_common_members(const schema::Texture& texture);
  schema::Texture described() const;

  schema::Texture model_;   // members common to all strokes, without values
  std::int64_t first_ = 0;  // of cells_, in pitches on the bench
  std::vector<Cell> cells_;
  std::vector<schema::AveragedStroke> strokes_;
  std::map<std::int64_t, schema::BandPoint> band_;  // by tenths of a millimetre on the bench
  double speeds_mps_ = 0;
  Names recordings_, surfaces_, simulations_;
};

}  // namespace tacto::spatial
