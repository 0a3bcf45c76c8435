// SPDX-License-Identifier: GPL-3.0-or-later
// The readers of project_file, one for each kind. Internal to this folder.
#pragma once

#include "analysis/report/project_file.hpp"
#include "spatial/picture/draw/shown_range.hpp"

namespace tacto::analysis {

using Progress = std::function<void(double)>;

/// Each sets what its kind contains. Errors: those of reading.
schema::Result<void> read_into(const std::string& path, schema::FileKind kind, ProjectFile& file,
                               const Progress& progress);

schema::Result<void> add_recording(const std::string& path, ProjectFile& file, const Progress& progress);
schema::Result<void> add_texture_file(const std::string& path, ProjectFile& file);
schema::Result<void> add_transducer(const std::string& path, ProjectFile& file);
schema::Result<void> add_spectrogram(const std::string& path, ProjectFile& file);
schema::Result<void> add_formants(const std::string& path, ProjectFile& file);
schema::Result<void> add_descriptions(const std::string& path, ProjectFile& file);
schema::Result<void> add_calibration(const std::string& path, ProjectFile& file);
schema::Result<void> add_scene(const std::string& path, ProjectFile& file);
schema::Result<void> add_session(const std::string& path, ProjectFile& file, const Progress& progress);
schema::Result<void> add_session_table(const std::string& path, ProjectFile& file);
schema::Result<void> add_height_map(const std::string& path, ProjectFile& file);
schema::Result<void> add_mesh(const std::string& path, ProjectFile& file);
schema::Result<void> add_volume(const std::string& path, ProjectFile& file);
schema::Result<void> add_results(const std::string& path, ProjectFile& file);
schema::Result<void> add_trade_table(const std::string& path, ProjectFile& file);
schema::Result<void> add_corpus_plan(const std::string& path, ProjectFile& file);
schema::Result<void> add_protocol(const std::string& path, ProjectFile& file);
schema::Result<void> add_device(const std::string& path, ProjectFile& file);
schema::Result<void> add_hand(const std::string& path, ProjectFile& file);

/// A signal as minimum and maximum of at most 1,000 pieces, so that a page can show any length. A rare spike
/// that would compress the rest (spatial::shown_range; at most a thousandth of the samples) is a gap in the
/// curve, and described in words.
class Envelope {
 public:
  explicit Envelope(std::size_t samples);
  void add(double x, double y);
  schema::ResultPicture picture(const std::string& title, const std::string& x_label,
                                const std::string& y_label, const std::string& unit) const;

 private:
  schema::ResultCurve curve(const spatial::ShownRange& range) const;
  struct Piece {
    double x = 0, low = 0, high = 0;
  };
  double least() const;
  double most() const;
  std::size_t per_piece_, in_piece_ = 0;
  std::size_t per_kept_, seen_ = 0;
  std::vector<Piece> pieces_;
  std::vector<double> kept_;  // every n-th value, at most 100,000, for percentiles
};

}  // namespace tacto::analysis
