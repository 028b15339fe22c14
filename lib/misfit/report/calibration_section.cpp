#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/text.h"
#include "misfit/math/camera.h"
#include "misfit/report/figures.h"
#include "misfit/report/rows.h"
#include "misfit/report/sections.h"

namespace misfit::report {
namespace {

std::string unit_of(const std::string& parameter) {
  for (std::size_t k = 0; k < camera_parameter_names.size(); ++k) {
    if (parameter == camera_parameter_names[k]) return camera_parameter_units[k];
  }
  return "-";
}

std::vector<Row> camera_rows(const Calibration& c) {
  std::vector<Row> rows;
  for (const std::string& name : c.names) rows.emplace_back(name, c.value(name), c.sigma(name), unit_of(name));
  rows.emplace_back("noise of one coordinate", c.sigma_px, 0.0, "px");
  rows.emplace_back("rms of the residuals", c.rms_px, 0.0, "px");
  return rows;
}

void tests_table(const Calibration& c, Page& page) {
  std::vector<std::vector<std::string>> rows = {{"parameter", "estimate when free", "drop", "p-value", "decision"}};
  for (const CameraTest& test : c.tests) {
    std::string estimate;
    for (std::size_t k = 0; k < test.parameters.size(); ++k) {
      const Row row(test.parameters[k], test.values[k], test.sigmas[k], unit_of(test.parameters[k]));
      estimate += (k == 0 ? "" : "; ") + row.what + " " + row.shown_number() + " " + row.shown_unit();
    }
    rows.push_back({test.name, estimate, fmt::format("{:.1f}", test.drop), fmt::format("{:.2g}", test.p_value),
                    test.selected ? "selected" : "fixed at its nominal value"});
  }
  if (rows.size() > 1) {
    page.subsection("Does the camera need more parameters?");
    page.paragraph(
        "Drop: 2 Δ log L for freeing the parameter, given those selected before; p-values are corrected for the number of candidates.");
  }
  page.table(rows);
}

}  // namespace

void calibration_section(const ReportInput& input, Page& page, const Draw& draw) {
  if (!input.calibration) return;
  const Calibration& c = *input.calibration;
  page.section("Calibration");
  page.paragraph(fmt::format("Camera model: {}. {} {}", c.model == CameraModel::pinhole ? "pinhole" : "plane by plane (the paper's Eq. 1)",
                             c.converged ? "The fit converged." : "The fit did not converge: " + c.message + ".",
                             c.outliers == 0
                                 ? "No point was rejected."
                                 : fmt::format("{} {} rejected as outliers.", c.outliers, c.outliers == 1 ? "point was" : "points were")));
  page.html(rows_html(camera_rows(c)));
  tests_table(c, page);
  if (c.residuals.empty()) return;
  draw(calibration_figure(c));
  draw(calibration_residual_figure(c));
}

}  // namespace misfit::report
