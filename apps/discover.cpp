#include <algorithm>
#include <iostream>
#include <optional>

#include "apps/ladder.h"
#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/core/ranks.h"

namespace misfit {
namespace {

Discovery discovered(Session& session) {
  const std::optional<Discovery> discovery = discover_stage(session);
  if (!discovery) refuse_declined(session);
  return *discovery;
}

/// The best accepted candidate that a study can take in one line.
std::optional<Candidate> next_step(const Discovery& discovery, const Registry& registry) {
  const std::vector<std::string> known = registry.effect_keys();
  for (const auto& candidate : discovery.candidates) {
    if (candidate.accepted && std::find(known.begin(), known.end(), candidate.effect) != known.end()) return candidate;
  }
  return std::nullopt;
}

int extend_ladder(ModelLadder& ladder, const Registry& registry, bool json) {
  constexpr int most_rungs = 12;
  for (int k = 0; k < most_rungs; ++k) {
    const Discovery discovery = discovered(ladder.last());
    if (!json) print(discovery);
    const std::optional<Candidate> next = next_step(discovery, registry);
    if (!next) break;
    const Rung& rung = ladder.add(next->effect, next);
    if (!json) print(ladder.ladder(), rung, ladder.last_fit());
  }
  static_cast<void>(ladder.last_rung());
  report_ladder(ladder);
  if (json) {
    print_file(ladder.root().folder.file("ladder.json"));
  } else {
    print(ladder.ladder());
  }
  return 0;
}

}  // namespace

int discover_verb(const Options& options, const Registry& registry) {
  Options own = options;
  own.quiet = options.quiet || !ranks().first();
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
  if (options.automatic) return extend_ladder(*ladder, registry, options.json);
  Session& session = ladder->last();
  session.options.threads = own.threads;
  const Discovery discovery = discovered(session);
  if (!ranks().first()) return 0;
  if (options.json) {
    print_file(session.folder.file("candidates.json"));
    return 0;
  }
  print(discovery);
  if (const auto next = next_step(discovery, registry))
    std::cout << "to add it: misfit add " << options.study << " " << next->effect << '\n';
  return 0;
}

}  // namespace misfit
