#include <iostream>

#include "apps/print.h"
#include "apps/verbs.h"
#include "misfit/workflow/ladder.h"

namespace misfit {
namespace {

/// "input_gain acts at its default place: input = u, port = dw/dt"; "" where its roles are said already, or it has none.
std::string place_in_words(ModelLadder& ladder, const std::string& effect, const std::optional<Candidate>& prediction) {
  if (effect.starts_with("system:") || (prediction && !prediction->roles.empty())) return "";
  std::string out;
  for (const auto& [role, name] : default_place(ladder.last(), effect)) out += (out.empty() ? "" : ", ") + role + " = " + name;
  return out.empty() ? "" : effect + " acts at its default place: " + out + "\n";
}

}  // namespace

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
  std::cout << place_in_words(ladder, options.effect, prediction);
  std::cout << "study of this rung: " << root.folder.file(rung.study).lexically_normal().string() << '\n';
  print_verdict(verdict_of(root, fit_stage(root)), root.folder.file("report.html"));
  return 0;
}

}  // namespace misfit
