#pragma once

#include <optional>

#include "misfit/discover/discover.h"

namespace misfit {

/// A dependence that no known effect describes.
struct Unexplained {
  std::string port, quantity;
  double p_value = 1.0;
};

/// The verdict in one sentence, and what would separate a group; `camera`: the measurements are those of a calibrated one.
void write_verdict(Discovery& out, const std::optional<Unexplained>& unexplained, double p_accept, bool camera);

/// "its strength friction ends at the bound 40 N m: not believable" for the first of these parameters that lies within a thousandth of its
/// scale of a bound other than 0; nullopt if none does. A strength at 0 is an effect that is off, and its drop says so.
[[nodiscard]] std::optional<std::string> ends_at_bound(const Model& model, const std::vector<int>& strengths);

/// Remarks on the camera: what the sweep asks for and the model does not have (kept in Discovery::sweep_asks). Nothing is accepted then:
/// the drop of a sensor effect is the sweep's prior, which a calibration has to follow up, not the flight; and physics seen through a wrong
/// camera may be the camera's. Where the flight asks for physics too, be it refused, of unknown form or not yet refitted (p below
/// `p_accept`), sweep and flight disagree.
void add_camera_remarks(const Calibration* calibration, double p_accept, Discovery& out);

}  // namespace misfit
