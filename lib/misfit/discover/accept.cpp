#include "misfit/discover/accept.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/discover/likeness.h"
#include "misfit/discover/verdict.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double tie = 6.0;  // refitted drops nearer than this do not tell two effects apart (DESIGN 6)

std::string named(const Candidate& c) { return effect_at(c.effect, c.roles); }

/// The score of another effect, at its best cell, in the model that holds the refitted one; no value: it has none there.
std::optional<ScoreResult> score_after(const Refit& in, const Entry& other, const Searched& searched) {
  const std::vector<Specimen> list = specimens(in.estimate, in.request, searched.registry, searched.options.calibration);
  const auto specimen = std::find_if(list.begin(), list.end(), [&](const Specimen& s) {
    return s.effect == other.candidate.effect && s.roles == other.candidate.roles;
  });
  if (specimen == list.end()) return std::nullopt;
  const Eigen::MatrixXd columns = specimen_columns(in.estimate, *specimen, other.screened->cell);
  if (columns.size() == 0) return std::nullopt;
  const ScoreResult result = ScoreTest(in.estimate).test(columns, specimen->has_priors ? &specimen->priors : nullptr);
  return result.dof > 0 ? std::optional(result) : std::nullopt;
}

/// Has `other` a significant score in the model that holds the refitted effect?
bool adds_to(const Refit& in, const Entry& other, const Searched& searched) {
  const auto result = score_after(in, other, searched);
  return result && chi_square_tail(result->chi2, result->dof) < searched.options.p_accept;
}

/// Another known effect whose score in the model that holds `in` is less likely by chance than that of the unknown curve: what remains is
/// not unknown, and is screened again once `in` is in.
const Entry* known_for(const UnknownCurve& left, const Entry& in, const std::vector<Entry>& entries, const Searched& searched) {
  for (const Entry& other : entries) {
    if (&other == &in || !other.screened->runs || other.candidate.described || other.candidate.p_value > searched.options.p_accept) continue;
    const auto result = score_after(*in.refit, other, searched);
    if (!result) continue;
    const double log_p = log_chi_square_tail(result->chi2, result->dof) + std::log(other.screened->cells_effective);
    if (log_p < left.log_p) return &other;
  }
  return nullptr;
}

/// Why it cannot be accepted by itself; empty: it can, and holds out.
std::string refusal(Entry& e, const Searched& searched) {
  Candidate& c = e.candidate;
  if (!(c.p_value < searched.options.p_accept)) return "not significant: family-wise p " + format_probability(c.p_value);
  if (const auto bound = ends_at_bound(e.refit->estimate.model, e.screened->specimen->strengths)) return *bound;
  c.held_out_gain = held_out_gain(searched.estimate, e.refit->estimate, searched.experiments, searched.options.threads);
  return *c.held_out_gain > 0.0 ? "" : "the held-out likelihood does not rise (" + format_value(*c.held_out_gain) + ")";
}

/// Words for those that were refitted and come behind the accepted one.
void tell_others(std::vector<Entry>& entries) {
  const Candidate& best = entries.front().candidate;
  for (std::size_t k = 1; k < entries.size(); ++k) {
    Candidate& other = entries[k].candidate;
    if (!other.why.empty() || !entries[k].refit) continue;
    other.why = !other.group.empty() ? "these data cannot tell it from " + named(best)
                                     : "explains less than " + named(best) + "; screened again once that is in";
  }
}

}  // namespace

void find_groups(std::vector<Entry>& entries, const Searched& searched) {
  if (entries.empty() || !entries.front().refit) return;
  Entry& best = entries.front();
  std::vector<Entry*> members = {&best};
  for (std::size_t k = 1; k < entries.size(); ++k) {
    Entry& other = entries[k];
    if (!other.refit || std::abs(other.refit->drop - best.refit->drop) > tie) continue;
    if (adds_to(*best.refit, other, searched) || adds_to(*other.refit, best, searched)) continue;
    members.push_back(&other);
  }
  if (members.size() < 2) return;
  std::vector<std::string> group;
  for (const Entry* e : members) group.push_back(named(e->candidate));
  for (Entry* e : members) e->candidate.group = group;
}

std::optional<UnknownCurve> accept_best(std::vector<Entry>& entries, const Searched& searched) {
  auto first = entries.begin();
  for (; first != entries.end() && first->refit; ++first) {
    first->candidate.why = refusal(*first, searched);
    if (first->candidate.why.empty()) break;
  }
  const bool holds_out = first != entries.end() && first->refit;
  if (holds_out) std::rotate(entries.begin(), first, first + 1);
  if (entries.empty()) return std::nullopt;
  Entry& best = entries.front();
  if (!best.refit || !(best.candidate.p_value < searched.options.p_accept)) return std::nullopt;
  const auto left = what_is_left(best.refit->estimate, *best.screened->specimen, best.refit->drop, searched.options);
  if (!holds_out) return left;
  Candidate& c = best.candidate;
  const Entry* next = left ? known_for(*left, best, entries, searched) : nullptr;
  if (left && next == nullptr) {
    c.why = "most of the departure remains: after it an unknown " + left->port + "(" + left->quantity + ") still has p " +
            format_probability(left->p_value);
    return left;
  }
  c.accepted = true;
  c.why = "family-wise p " + format_probability(c.p_value) + ", held-out gain " + format_value(*c.held_out_gain);
  if (next != nullptr) c.why += "; what remains after it, " + named(next->candidate) + " explains";
  tell_others(entries);
  return std::nullopt;
}

}  // namespace misfit
