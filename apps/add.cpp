#include <iostream>

#include "apps/ladder.h"
#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"

namespace misfit {
namespace {

/// What discovery says of the effect: roles, where to start, the drop it predicts. Asked before the effect is added, so that the prediction
/// is one. nullopt for a change of system, which no discovery ranks.
std::optional<Candidate> candidate_of(Session& session, const std::string& effect) {
  if (effect.starts_with("system:")) return std::nullopt;
  static_cast<void>(session.registry.effect(effect));  // InputError with the nearest name
  try {
    static_cast<void>(study_with_effect(session, effect, std::nullopt, session.folder.path()));  // refuses what cannot be added
  } catch (const InputError&) {
    // Not where it would go by default, or it is there already: discovery may know another place.
    auto elsewhere = predict_effect(session, effect);
    if (!elsewhere || elsewhere->roles.empty()) throw;
    return elsewhere;
  }
  return predict_effect(session, effect);
}

}  // namespace

int add_verb(const Options& options, const Registry& registry) {
  ModelLadder ladder(options, registry);
  const std::optional<Candidate> candidate = candidate_of(ladder.last(), options.effect);
  const Rung& rung = ladder.add(options.effect, candidate);
  report_ladder(ladder);
  if (options.json) {
    print_file(ladder.root().folder.file("ladder.json"));
    return 0;
  }
  print(ladder.ladder(), rung, ladder.last_fit());
  print(ladder.ladder());
  std::cout << "study of this rung: " << ladder.root().folder.file(rung.study).lexically_normal().string() << '\n';
  return 0;
}

}  // namespace misfit
