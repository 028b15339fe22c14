#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/discover/discover.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/jobs/job_queue.h"
#include "misfit/jobs/ranks.h"
#include "misfit/workflow/assess/assess.h"

namespace misfit {
namespace {

constexpr const char* refits = "discover_refits";

/// The search itself; `only`: of one effect (DiscoverOptions).
Discovery search(Session& session, const std::string& only, std::function<bool(const Candidate&)> refit_best_of = {}) {
  const std::optional<Calibration> calibration = calibrate_stage(session);
  const auto work = filter_work(session);
  DiscoverOptions options;
  options.threads = session.options.threads;
  options.calibration = calibration ? &*calibration : nullptr;
  options.only = only;
  options.refit_best_of = std::move(refit_best_of);
  options.progress = session.progress("discover");
  if (only.empty()) options.refits = {session.folder.file(refits), digest_of(inputs_of_discovery(session)), 0, session.options.threads};
  options.stop = &interrupted();
  constexpr double refits_of_a_round = 10.0;
  options.refit_limit = session.asked_limit().value_or(usual_refit_limit(session.options, work->fit.seconds));
  options.round_limit = session.round_limit().value_or(refits_of_a_round * options.refit_limit);
  const Watch watch("discover", 0.0, session.options.listener.progress_of("discover"));
  try {
    return discover({*work->estimate, work->prepared.request, session.registry, work->prepared.experiments}, options);
  } catch (const RunError&) {
    stop_if_interrupted();
    throw;
  }
}

using Roles = std::map<std::string, std::string>;

bool is_at(const Candidate& candidate, const Roles& by_default, const AskedPlace& place) {
  if (place.by_default) return candidate.roles.empty();
  const Roles& own = candidate.roles.empty() ? by_default : candidate.roles;
  return std::all_of(place.roles.begin(), place.roles.end(), [&](const auto& role) {
    const auto found = own.find(role.first);
    return found != own.end() && found->second == role.second;
  });
}

/// "--at default (input=u, port=dw/dt)" or "--at input=u2 --at port=dw/dt".
std::string place_in_words(const Candidate& candidate, const Roles& by_default) {
  const std::string words = fmt::format(" --at {}", fmt::join(words_of_place(candidate), " --at "));
  return candidate.roles.empty() && !by_default.empty() ? fmt::format("{} ({})", words, fmt::join(words_of_place(by_default), ", "))
                                                        : words;
}

/// nullptr: the effect is not listed. InputError: it is, but at other places only.
const Candidate* candidate_at(const Discovery& discovery, const std::string& effect, const Roles& by_default, const AskedPlace& place) {
  std::string others;
  for (const auto& candidate : discovery.candidates) {
    if (candidate.effect != effect) continue;
    if (is_at(candidate, by_default, place)) return &candidate;
    others += (others.empty() ? "" : " |") + place_in_words(candidate, by_default);
  }
  if (others.empty()) return nullptr;
  throw InputError("--at: discovery does not list " + effect + " there, but at" + others);
}

}  // namespace

AskedPlace asked_place(const std::vector<std::string>& words) {
  AskedPlace out;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    if (word == "default" && words.size() == 1) {
      out.by_default = true;
    } else if (equals == std::string::npos || equals == 0 || equals + 1 == word.size()) {
      throw InputError("--at " + shown(word) + ": ROLE=NAME is expected, such as rate=w, or default alone");
    } else {
      out.roles[word.substr(0, equals)] = word.substr(equals + 1);
    }
  }
  return out;
}

std::optional<Candidate> predict_effect(Session& session, const std::string& effect, const AskedPlace& place) {
  if (filter_declined(session)) refuse_declined(session);
  stop_if_interrupted();
  const bool listed = !session.registry.effect(effect).spec().has_unknown_form();  // those are listed as unknown curves
  const Roles by_default = default_place(session, effect);
  const auto known = listed ? known_discovery(session) : std::nullopt;
  const Discovery discovery = known ? *known : search(session, effect, [&](const Candidate& c) { return is_at(c, by_default, place); });
  const Candidate* found = candidate_at(discovery, effect, by_default, place);
  return found == nullptr ? std::nullopt : std::optional(*found);
}

std::optional<Discovery> discover_stage(Session& session) {
  if (filter_declined(session)) return std::nullopt;
  stop_if_interrupted();
  if (auto known = known_discovery(session)) return known;
  if (!ranks().first()) return search(session, "");
  session.do_stage("discover", inputs_of_discovery(session), {"candidates.json", "discovery.json"},
                   [&](const std::filesystem::path& dir) { write_discovery(dir, search(session, "")); });
  remove_stored_jobs(session.folder.file(refits));  // megabytes each, and all said
  return read_discovery(session.folder.path());
}

Discovery discovered(Session& session) {
  const std::optional<Discovery> discovery = discover_stage(session);
  if (!discovery) refuse_declined(session);
  return *discovery;
}

}  // namespace misfit
