#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/workflow/ladder.h"

namespace misfit {

int remove_verb(const Options& options, const Registry& registry) {
  ModelLadder ladder(options.session, registry);
  for (const auto& folder : ladder.remove(options.rung)) ladder.root().note("kept: " + folder.string());
  report_ladder(ladder);
  Session& root = ladder.root();
  if (options.json) {
    print_file(root.folder.file("ladder.json"));
    return 0;
  }
  print(ladder.ladder());
  print_verdict(verdict_of(root, fit_stage(root)), root.folder.file("report.html"));
  return 0;
}

}  // namespace misfit
