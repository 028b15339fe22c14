#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "misfit/data/column_map.h"

namespace misfit {

/// The apex in the image over time. All vectors have one entry per sample; lost samples keep their row.
struct Track {
  std::vector<double> t;           ///< [s], strictly increasing
  std::vector<double> P_y;         ///< [px] from the image centre, positive left looking upstream; NaN when lost
  std::vector<double> P_z;         ///< [px] from the image centre, positive down; NaN when lost
  std::vector<double> sigma;       ///< [px] standard deviation of one coordinate; NaN when not known
  std::vector<bool> ok;            ///< false: lost, not to be used
  std::vector<std::string> notes;  ///< what was dropped and why, in words
};

/// Names that the map of a track may have.
[[nodiscard]] const std::vector<std::string>& track_signals();

/// What a film gives the outputs of any system, by name or through the experiment's `columns`: x_px and y_px, column and row of what is
/// followed [px], pixel centres at integers, rows counted downwards; with a known length in the picture also x_m and y_m [m], to the right
/// and upwards from the origin. Of several markers x_px_NAME, y_px_NAME, x_m_NAME, y_m_NAME, of each.
[[nodiscard]] std::vector<std::string> film_channels(const std::vector<std::string>& markers = {});

/// Reads `t[s],P_y[px],P_z[px]` and, where present, `sigma[px]` and `ok`. Rows without t are dropped and said; time that does not increase
/// is an InputError with the line; all samples lost is a RunError; samples farther than 1e5 px from the centre are lost and said.
[[nodiscard]] Track read_track(const std::filesystem::path& path, const ColumnMap& columns = {});
void write_track(const std::filesystem::path& path, const Track& track);

}  // namespace misfit
