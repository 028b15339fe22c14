#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/workflow/ladder.h"

namespace misfit {

int add_verb(const Options& options, const Registry& registry) {
  const AskedPlace place = asked_place(options.at);  // first: wrong words change nothing
  ModelLadder ladder(options.session, registry);
  const std::optional<Candidate> prediction = prediction_for(ladder, options.effect, place);
  const Rung& rung = ladder.add(options.effect, prediction);
  report_ladder(ladder);
  if (options.json) {
    print_file(ladder.root().folder.file("ladder.json"));
    return 0;
  }
  print(ladder.ladder(), rung, ladder.last_fit());
  print(ladder.ladder());
  Session& root = ladder.root();
  std::cout << "study of this rung: " << root.folder.file(rung.study).lexically_normal().string() << '\n';
  print_verdict(verdict_of(root, fit_stage(root)), root.folder.file("report.html"));
  return 0;
}

}  // namespace misfit
