#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "misfit/core/error.h"

namespace misfit {

/// The static sweep: three reference points of the rig in the image at known angles. Geometry (x from the backshell face, all in the x-z
/// plane):
///   x1 = l_p + R1 cos, z1 = R1 sin;  x2 = l_p − R2 cos, z2 = R2 sin;  x3 = l_p + R3 cos, z3 = −R3 sin (paper, Fig. 4 and Eqs. 5-7; the
///   paper's P_1 = P_1z, P_2 = P_2z, P_3 = −P_3z).
struct Sweep {
  std::string source;                      ///< file it came from, for messages; may be empty
  std::vector<double> theta;               ///< [rad]
  std::array<std::vector<double>, 3> P_y;  ///< [px]; empty where the file gives one coordinate only; NaN = missing
  std::array<std::vector<double>, 3> P_z;  ///< [px]; NaN = missing
};

/// Reads `theta[deg],P_1y[px],P_1z[px],…,P_3z[px]`. P_ky may be absent. InputErrors as read_csv, and for
/// positions farther than 1e5 px from the image centre and more than 5000 rows.
[[nodiscard]] Sweep read_sweep(const std::filesystem::path& path);

/// Writes the same columns; points without any P_y leave that column out.
void write_sweep(const std::filesystem::path& path, const Sweep& sweep);

/// One position of the rig in pictures: an image, or the part of a video in which the rig stands still.
struct SweepPicture {
  double theta = 0.0;  ///< [rad]
  std::filesystem::path file;
  std::optional<double> from, to;  ///< [s] of the video; the whole of it without
  Source where;
};

/// Reads `theta[deg],file` and, for videos, `from[s],to[s]`; files are taken from the table's folder and must exist (InputError with the
/// line).
[[nodiscard]] std::vector<SweepPicture> read_sweep_pictures(const std::filesystem::path& path);

}  // namespace misfit
