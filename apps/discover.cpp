#include <iostream>
#include <optional>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/jobs/ranks.h"
#include "misfit/workflow/ladder.h"

namespace misfit {
namespace {

/// The report, and what it begins with, as `run` ends.
void end_with_verdict(ModelLadder& ladder) {
  Session& root = ladder.root();
  print_verdict(verdict_of(root, fit_stage(root)), root.folder.file("report.html"));
}

int extend(ModelLadder& ladder, const Registry& registry, const Options& options) {
  extend_ladder(ladder, registry, ladder_listener(ladder, options));
  report_ladder(ladder);
  if (options.json) {
    print_file(ladder.root().folder.file("ladder.json"));
    return 0;
  }
  if (!options.verbose) std::cout << '\n';
  print(ladder.ladder());
  end_with_verdict(ladder);
  return 0;
}

}  // namespace

LadderListener ladder_listener(ModelLadder& ladder, const Options& options) {
  LadderListener listener;
  if (options.json) return listener;
  if (options.verbose) {
    listener.discovered = [](const Discovery& discovery) { print(discovery); };
    listener.added = [&](const Rung& rung) { print(ladder.ladder(), rung, ladder.last_fit()); };
  } else {
    listener.discovered = [](const Discovery& discovery) { print_stage("discover", line_of(discovery)); };
    listener.added = [](const Rung& rung) {
      print_stage("add", rung.added + ": " + line_of(rung) + "; the test whether it stays comes next");
    };
  }
  return listener;
}

int discover_verb(const Options& options, const Registry& registry) {
  SessionOptions own = options.session;
  if (options.automatic && ranks().size() > 1)
    throw InputError("discover --auto cannot run under mpirun: each rung depends on the one before; discover without --auto can");
  // The fit that discovery starts from is written by one rank only; the others find it done.
  std::optional<ModelLadder> ladder;
  on_first_rank([&] {
    ladder.emplace(own, registry);
    if (filter_declined(ladder->last())) refuse_declined(ladder->last());
  });
  if (own.threads == 0) own.threads = threads_of_rank();
  if (!ladder) ladder.emplace(own, registry);
  if (options.automatic) return extend(*ladder, registry, options);
  Session& session = ladder->last();
  session.options.threads = own.threads;
  const Discovery discovery = discovered(session);
  if (!ranks().first()) return 0;
  if (options.json) {
    print_file(session.folder.file("candidates.json"));
    return 0;
  }
  print(discovery);
  report_ladder(*ladder);
  end_with_verdict(*ladder);
  return 0;
}

}  // namespace misfit
