#include "misfit/workflow/export.h"

#include <iostream>

#include "apps/verbs.h"
#include "misfit/core/text.h"

namespace misfit {

int export_verb(const Options& options, const Registry& registry) {
  const ExportReport report = export_stage(options.session, registry, options.export_request);
  const Exported& exported = report.exported;
  if (!options.quiet) {
    std::cerr << "exporting the estimate by " << exported.fit.method << (exported.rung.empty() ? "" : " of " + exported.rung) << '\n';
    if (!report.lack.empty())
      std::cerr << "note: only curves and parameters are written, not the equations of motion: " << report.lack << '\n';
    if (!report.left_out.empty())
      std::cerr << "note: effects of the model that are not in the file: " << join_words(report.left_out) << '\n';
  }
  std::cout << report.text;
  for (const auto& file : report.files) std::cout << file.lexically_normal().string() << '\n';
  return 0;
}

}  // namespace misfit
