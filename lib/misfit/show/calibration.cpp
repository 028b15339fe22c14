// The way from pictures to angles: calibration, track, attitude.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/show/results.h"
#include "misfit/show/rows.h"

namespace misfit {
namespace {

std::string unit_of(const std::string& parameter) {
  const auto found = std::find(camera_parameter_names.begin(), camera_parameter_names.end(), parameter);
  return found == camera_parameter_names.end() ? "-" : camera_parameter_units[found - camera_parameter_names.begin()];
}

TableBlock camera_table(const Calibration& c) {
  TableBlock table{columns("parameter|value|status")};
  for (const std::string name : camera_parameter_names) {
    const bool free = std::find(c.names.begin(), c.names.end(), name) != c.names.end();
    if (free || c.value(name) != 0.0)
      table.rows.push_back({name, Row(name, c.value(name), c.sigma(name), unit_of(name)).shown(), free ? "estimated" : "fixed"});
  }
  if (c.residuals.empty()) return table;
  table.rows.push_back({"noise of one coordinate", Row("", c.sigma_px, 0.0, "px").shown(), "estimated"});
  table.rows.push_back({"residual RMS", Row("", c.rms_px, 0.0, "px").shown(), ""});
  return table;
}

TableBlock test_table(const Calibration& c) {
  TableBlock table{columns("tested parameter|estimate when free|>drop|>p (corrected)|decision")};
  for (const CameraTest& test : c.tests) {
    std::string estimate;
    for (std::size_t k = 0; k < test.parameters.size(); ++k) {
      const std::string& name = test.parameters[k];
      estimate += (k == 0 ? "" : "; ") + name + " " + Row(name, test.values[k], test.sigmas[k], unit_of(name)).shown();
    }
    table.rows.push_back({test.name, estimate, shown_drop(test.drop), format_probability(test.p_value),
                          test.selected ? "estimated" : "fixed at its nominal value"});
  }
  return table;
}

}  // namespace

Blocks blocks_of(const Calibration& c) {
  Blocks out;
  out.heading("Calibration");
  out.paragraph(fmt::format("Camera model: {}. {}", c.model == CameraModel::pinhole ? "pinhole" : "plane by plane (the paper's Eq. 1)",
                            as_sentence(c.message)));
  if (!c.converged) out.paragraph("The calibration did not converge.", Tone::warning);
  out.table(camera_table(c));
  if (!c.tests.empty()) {
    out.subheading("Tests of further camera parameters");
    out.paragraph("Drop: 2 Δ log L for freeing the parameter, given those selected before; p is corrected for the number of candidates.");
    out.table(test_table(c));
  }
  if (!c.residuals.empty()) out.figures("residuals");
  out.warnings(c.notes);
  return out;
}

Blocks blocks_of(const std::string& experiment, const TrackFacts& facts) {
  Blocks out;
  out.subheading("Track of " + experiment);
  out.warnings(facts.warnings);
  if (facts.plane) out.warnings(facts.plane->warnings);
  out.list({sentences(facts)});
  return out;
}

Blocks blocks_of(const std::string& experiment, const Attitude& a) {
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (double v : a.alpha_T) {
    if (std::isfinite(v)) sum += v, squares += v * v, n += 1.0;
  }
  const double mean = n > 0.0 ? sum / n : std::nan("");
  const double spread = std::sqrt(std::max(squares / std::max(n, 1.0) - mean * mean, 0.0));
  Blocks out;
  out.subheading("Attitude of " + experiment);
  out.table({columns("quantity|value"),
             {{"samples read", fmt::format("{} of {}", samples_read(a), a.t.size())},
              {"mean of alpha_T", Row("", mean, 0.0, "rad").shown()},
              {"standard deviation of alpha_T", Row("", spread, 0.0, "rad").shown()}}});
  out.warnings(a.notes);
  return out;
}

}  // namespace misfit
