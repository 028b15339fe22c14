#pragma once

#include "misfit/discover/discover.h"

namespace misfit {

/// A dependence that no known effect describes.
struct Unexplained {
  std::string port, quantity;
  double p_value = 1.0;
};

/// The verdict in one sentence, and what would separate a group.
void write_verdict(Discovery& discovery, const std::optional<Unexplained>& unexplained, double p_accept);

/// Remarks on the camera: what the sweep asks for and the model does not have.
void add_camera_remarks(const Calibration* calibration, Discovery& discovery);

}  // namespace misfit
