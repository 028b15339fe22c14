#include "misfit/report/report.h"

#include "misfit/core/files.h"
#include "misfit/report/sections.h"

namespace misfit::report {

std::filesystem::path write_report(const std::filesystem::path& dir, const ReportInput& input) {
  make_writable_folder(dir);
  Page page(input.study.empty() ? "Report" : input.study, input.run.date);
  page.question(input.question);
  Draw draw(page);
  verdict_section(input, page, draw);
  ladder_section(input, page, draw);
  const std::vector<ModelResults> models = models_of(input);
  for (const ModelResults& model : models) {
    summary_section(input, model, page);
    curves_section(model, input.references, page, draw);
    page.fold_sections();
  }
  diagnosis_section(input, page, draw);
  discovery_section(input, page, draw);
  uncertainty_section(input, page, draw);
  resampling_section(input, page, draw);
  for (const ModelResults& model : models) prediction_section(model, page, draw);
  simulated_section(input, page, draw);
  track_section(input, page, draw);
  measured_section(input, page, draw);
  for (const ModelResults& model : models) parameters_section(model, page);
  calibration_section(input, page, draw);
  notes_section(input, page);
  words_section(page);
  provenance_section(input, page);
  page.draw(dir / "figures");
  constexpr std::size_t most = 8'000'000;  // bytes: what mail takes
  const std::size_t document = page.text().size();
  if (input.explorer && document < most) page.explorer(input.explorer(most - document));
  std::filesystem::path path = dir / "report.html";
  write_atomically(path, page.text());
  return path;
}

}  // namespace misfit::report
