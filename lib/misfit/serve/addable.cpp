#include "misfit/serve/addable.h"

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/error.h"
#include "misfit/page/json_text.h"
#include "misfit/workflow/ladder.h"

namespace misfit::serve {
namespace {

bool has_another_place(const std::string& effect, const std::optional<Discovery>& discovery) {
  return discovery && std::any_of(discovery->candidates.begin(), discovery->candidates.end(),
                                  [&](const Candidate& c) { return c.effect == effect && !c.roles.empty(); });
}

}  // namespace

std::vector<Addable> addable_effects(const Session& session, const std::optional<Discovery>& discovery) {
  std::vector<Addable> out;
  for (const std::string& effect : session.registry.effect_keys()) {
    out.push_back({effect, session.registry.effect(effect).spec().formula, ""});
    try {
      (void)study_with_effect(session, effect, std::nullopt, session.folder.path());
    } catch (const InputError& error) {
      if (!has_another_place(effect, discovery)) out.back().refused = error.what();
    }
  }
  return out;
}

std::string json_of(const std::vector<Addable>& effects) {
  std::vector<std::string> out;
  for (const Addable& one : effects)
    out.push_back(fmt::format(R"({{"effect":{},"formula":{},"refused":{}}})", page::json_string(one.effect), page::json_string(one.formula),
                              page::json_string(one.refused)));
  return page::json_list(out);
}

}  // namespace misfit::serve
