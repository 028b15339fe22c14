#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/workflow/ladder.h"

namespace misfit {

int add_verb(const Options& options, const Registry& registry) {
  ModelLadder ladder(options.session, registry);
  const std::optional<Candidate> prediction = prediction_for(ladder, options.effect);
  const Rung& rung = ladder.add(options.effect, prediction);
  report_ladder(ladder);
  if (options.json) {
    print_file(ladder.root().folder.file("ladder.json"));
    return 0;
  }
  std::cout << rung_text(ladder.ladder(), rung) << warnings_text(ladder.last_fit()) << '\n' << ladder_text(ladder.ladder());
  std::cout << "\nstudy of this rung: " << ladder.root().folder.file(rung.study).lexically_normal().string() << '\n';
  return 0;
}

}  // namespace misfit
