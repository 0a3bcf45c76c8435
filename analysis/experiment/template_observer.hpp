// SPDX-License-Identifier: GPL-3.0-or-later
// A simulated participant of an identification.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/experiment/observer.hpp"
#include "analysis/experiment/study.hpp"

namespace tacto::analysis {

/// RMS of a displacement along position in third-octave bands of spatial frequency, dB re 1 um, with a floor
/// at 0.1 um. The bands are those within 15-500 Hz at `speed_mps`, from the low one on. A Hann window over
/// the path; each sample is weighted by the way that it stands for. Precondition: the same length, at least
/// 8; the position moves in one direction.
std::vector<double> band_levels_db(std::span<const double> position_m, std::span<const double> displacement_m,
                                   double speed_mps);

/// Compares band levels with those of the standards and answers the nearest standard (Euclid), after a normal
/// error of each band level. Of a session it gets the displacement that the session predicts, not what it
/// was; a real sample, of which there is no session, is to it the displacement of its texture without a
/// device. The errors are tuned so that identifying the emulated surfaces C, D and E among A to E succeeds in
/// 0.93 (real) and 0.75 (virtual) of the trials, the figures of Wiertlewski 2011: they say nothing about
/// people.
class TemplateObserver {
 public:
  /// Errors: those of read_texture.
  static schema::Result<TemplateObserver> of(const Study& study);

  /// The choice, from 1; by chance, if the session has no whole stroke. `code`: of the real sample; it is not
  /// read where there is a session. `place` names the attempt, as P01/17.
  int answer(const Observer& observer, const std::string& place, const std::string& code,
             const std::optional<std::string>& session) const;

  /// The choice for band levels.
  int nearest(const Observer& observer, const std::string& place, const std::vector<double>& levels_db,
              bool real) const;

 private:
  struct Template {
    std::string code;
    std::vector<double> levels_db;
  };
  std::vector<Template> standards_;  // in the order of the choices
  double speed_mps_ = 0;
};

}  // namespace tacto::analysis
