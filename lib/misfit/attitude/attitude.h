#pragma once

// References
//   [P]  the paper (lib/misfit/README.md, [1]).

#include "misfit/core/table.h"
#include "misfit/data/attitude.h"
#include "misfit/data/calibration.h"
#include "misfit/data/geometry.h"
#include "misfit/data/track.h"

namespace misfit {

struct AttitudeOptions {
  double even = 0.2;   ///< steps that differ from the record's median step by more than this fraction are gaps [-]
  bool sigmas = true;  ///< false: values only, several times as fast; sigmas are missing
};

/// Attitude of the axis from the apex in the image, with the calibration's camera and model.
///
/// theta, psi as read (math/camera.h); three-point averages; rates of the averages by the fourth-order stencil
/// (f₋₂ − 8 f₋₁ + 8 f₁ − f₂)/12h (for times that are not quite even, the derivative of the polynomial through the five points, which is the
/// same where they are); then [P, Eqs. 2-4]
///   alpha = theta + (R_cp cos theta / V) theta',  beta = psi + (R_cp cos psi / V) psi',  alpha_T = acos(cos alpha cos beta),
/// the last as 2 atan2(sqrt(s), sqrt(1 − s)), s = a + b − 2ab, a = sin²(alpha/2), b = sin²(beta/2): exact near zero, where acos is not.
/// A value is NaN wherever one of the samples it needs is lost or across a gap: alpha needs seven in a row.
///
/// Sigmas are first-order and combine two sources: measurement noise, independent between samples and equal in P_y and P_z (Track::sigma;
/// where that is NaN, estimated by pixel_noise() and said), and the calibration's covariance, common to all samples. A note gives the share
/// of each. sigma_theta and sigma_psi are of the angles as read, sigma_phi of the averages, at most pi/sqrt(3) (nothing known: the axis at
/// zero tilt); sigma_alpha_T, whose direction is undefined at alpha_T = 0, is there the root mean square of those of alpha and beta. R,
/// R_cp, V and l_s count as exact; errors of the model of the canopy (jitter of disc against band) are not in it. Throws InputError for a
/// geometry that cannot be (R, V, l_b not positive, l_s not beyond R), RunError if no sample can be read at all.
[[nodiscard]] Attitude attitude(const Track& track, const Calibration& calibration, const RigGeometry& geometry,
                                const AttitudeOptions& options = {});

/// The attitude as a recording in SI: t, theta, psi, alpha, beta, alpha_T, eta, phi (unwrapped) and phi_rate, phi' being from the rates of
/// the averages through phi = atan2(tan psi, tan theta).
[[nodiscard]] Table attitude_table(const Attitude& attitude);

}  // namespace misfit
