#include "misfit/discover/accept.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/discover/alias.h"
#include "misfit/discover/verdict.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double tie = 6.0;  // refitted drops nearer than this do not distinguish two effects

std::string label(const Candidate& c) { return effect_at(c.effect, c.roles); }

/// Scores of other effects in the model that holds a refitted one.
class ConditionalScores {
 public:
  ConditionalScores(const Refit& in, const SearchContext& context)
      : in_(in), list_(candidate_models(in.estimate, in.request, context.registry, context.options.calibration)), score_(in.estimate) {}

  /// At the effect's best cell of the first search; dof 0 where the model describes it already, no value where it cannot be run with it.
  [[nodiscard]] std::optional<ScreeningResult> score(const RankedCandidate& other) const {
    ScreeningResult out;
    const auto candidate_model = std::find_if(list_.begin(), list_.end(), [&](const CandidateModel& s) {
      return s.effect == other.candidate.effect && s.roles == other.candidate.roles;
    });
    if (candidate_model == list_.end()) return std::nullopt;
    out.candidate_model = &*candidate_model;
    out.cell = other.screening->cell;
    out.cells_effective = other.screening->cells_effective;
    CellScore cell = score_cell(in_.estimate, score_, *candidate_model, out.cell);
    if (cell.columns.size() == 0) return std::nullopt;
    out.result = std::move(cell.result);
    out.columns = std::move(cell.columns);
    out.log_p = log_score_tail(*candidate_model, out.result.chi2) + std::log(out.cells_effective);
    return out;
  }

 private:
  const Refit& in_;
  std::vector<CandidateModel> list_;
  ScoreTest score_;
};

/// Once the refitted effect is in, has `other` no significant score? Not so where the two cannot be in one model: that says nothing.
bool adds_nothing(const ConditionalScores& in, const RankedCandidate& other, double p_accept) {
  const auto found = in.score(other);
  return found && (found->result.dof == 0 || !(chi_square_tail(found->result.chi2, found->result.dof) < p_accept));
}

/// The other known effect with the least likely score in the model that holds `in`, be it silent before, if it is significant there.
struct SecondEffect {
  const RankedCandidate* entry = nullptr;
  ScreeningResult score;
};
SecondEffect second_effect_given(const RankedCandidate& in, const ConditionalScores& conditional,
                                 const std::vector<RankedCandidate>& ranked, double p_accept) {
  SecondEffect best;
  for (const RankedCandidate& other : ranked) {
    if (&other == &in || !other.screening->runs || other.candidate.described || other.candidate.family == "sensor") continue;
    auto found = conditional.score(other);
    if (!found || found->result.dof == 0 || (best.entry != nullptr && found->log_p >= best.score.log_p)) continue;
    best = {&other, std::move(*found)};
  }
  if (best.entry != nullptr && sidak(std::min(1.0, std::exp(best.score.log_p)), static_cast<double>(ranked.size())) > p_accept)
    best.entry = nullptr;
  return best;
}

/// Is `in` still needed beside the other? 2 [log L(both) − log L(other alone)], as any refitted drop family-wise.
bool needed_given(const RankedCandidate& in, const Refit& both, const RankedCandidate& other, const SearchContext& context) {
  std::optional<Refit> fitted;
  if (!other.refit) fitted = refit(context.estimate, context.experiments, *other.screening, context.registry, context.options.threads);
  const Refit& alone = other.refit ? *other.refit : *fitted;
  if (!alone.ok || !alone.estimate.converged) return false;
  const double drop = in.refit->drop + both.drop - alone.drop;
  const double log_p = log_score_tail(*in.screening->candidate_model, drop) + std::log(in.screening->cells_effective);
  return sidak(std::min(1.0, std::exp(log_p)), context.families) < context.options.p_accept;
}

CandidateModel with_quantities(CandidateModel candidate_model, const std::vector<int>& quantities) {
  candidate_model.quantities.insert(candidate_model.quantities.end(), quantities.begin(), quantities.end());
  return candidate_model;
}

/// Another known effect with which nothing remains after `in`.
const RankedCandidate* explaining_effect(const RankedCandidate& in, const std::vector<RankedCandidate>& ranked,
                                         const SearchContext& context) {
  const DiscoverOptions& options = context.options;
  const ConditionalScores conditional(*in.refit, context);
  const SecondEffect second = second_effect_given(in, conditional, ranked, options.p_accept);
  if (second.entry == nullptr) return nullptr;
  const Refit both = refit(in.refit->estimate, context.experiments, second.score, context.registry, options.threads);
  if (!both.ok || !both.estimate.converged || !(both.drop > 0.0)) return nullptr;
  const Model& model = both.estimate.model;
  const std::vector<int>&strengths = in.screening->candidate_model->strengths, &others = second.score.candidate_model->strengths;
  if (ends_at_bound(model, strengths) || ends_at_bound(model, others)) return nullptr;
  if (!needed_given(in, both, *second.entry, context)) return nullptr;
  // Measured against the drop of `in` alone, as what it left by itself was: the second is added to explain just that remainder, and
  // the better it does the less may be left, not the more.
  const CandidateModel reads = with_quantities(*second.score.candidate_model, in.screening->candidate_model->quantities);
  return remaining_lack_of_fit(both.estimate, reads, in.refit->drop, options) ? nullptr : second.entry;
}

/// Why it cannot be accepted by itself; empty: it can, and holds out.
std::string refusal(RankedCandidate& e, const SearchContext& context) {
  Candidate& c = e.candidate;
  if (!(c.p_value < context.options.p_accept)) return "not significant: family-wise " + p_equals(c.p_value);
  if (!e.refit->estimate.converged) return "its refit has not converged: " + e.refit->estimate.message;
  if (const auto bound = ends_at_bound(e.refit->estimate.model, e.screening->candidate_model->strengths)) return *bound;
  c.held_out_gain = held_out_gain(context.estimate, e.refit->estimate, context.experiments, context.options.threads);
  return *c.held_out_gain > 0.0 ? "" : "the held-out likelihood does not rise (" + format_value(*c.held_out_gain) + ")";
}

/// Groups the front with what these data cannot distinguish from it.
void find_groups(std::vector<RankedCandidate>& ranked, const SearchContext& context) {
  if (ranked.empty() || !ranked.front().refit) return;
  RankedCandidate& best = ranked.front();
  std::vector<RankedCandidate*> members = {&best};
  const ConditionalScores given_best(*best.refit, context);
  const double p_accept = context.options.p_accept;
  for (std::size_t k = 1; k < ranked.size(); ++k) {
    RankedCandidate& other = ranked[k];
    if (!other.refit || std::abs(other.refit->drop - best.refit->drop) > tie) continue;
    if (!adds_nothing(given_best, other, p_accept) || !adds_nothing(ConditionalScores(*other.refit, context), best, p_accept)) continue;
    members.push_back(&other);
  }
  if (members.size() < 2) return;
  std::vector<std::string> group;
  for (const RankedCandidate* e : members) group.push_back(label(e->candidate));
  for (RankedCandidate* e : members) e->candidate.group = group;
}

/// Reasons for those that were refitted and are not accepted, the accepted one in front.
void explain_others(std::vector<RankedCandidate>& ranked) {
  const Candidate& best = ranked.front().candidate;
  for (std::size_t k = 1; k < ranked.size(); ++k) {
    Candidate& other = ranked[k].candidate;
    if (!other.why.empty() || !ranked[k].refit) continue;
    const bool alike = std::find(other.group.begin(), other.group.end(), label(best)) != other.group.end();
    const bool more = ranked[k].refit->drop > ranked.front().refit->drop;
    other.why = alike  ? "these data cannot distinguish it from " + label(best)
                : more ? "less significant than " + label(best) + " for its number of parameters; tested again with that in the model"
                       : "explains less than " + label(best) + "; tested again with that in the model";
  }
}

/// What was found on the way through the list.
struct Selection {
  std::vector<RankedCandidate>::iterator at;  ///< of what is accepted, or the end
  const RankedCandidate* next = nullptr;      ///< what explains what it leaves, where it leaves something
  std::optional<UnknownCurve> remaining;      ///< after the first that holds out
};

Selection select(std::vector<RankedCandidate>& ranked, const SearchContext& context) {
  Selection out{ranked.end(), nullptr, std::nullopt};
  std::vector<std::vector<RankedCandidate>::iterator> aliases;
  std::vector<int> read;  // by the aliases
  for (auto e = ranked.begin(); e != ranked.end() && e->refit; ++e) {
    e->candidate.why = refusal(*e, context);
    if (!e->candidate.why.empty()) continue;
    const CandidateModel& candidate_model = *e->screening->candidate_model;
    const auto left = remaining_lack_of_fit(e->refit->estimate, with_quantities(candidate_model, read), e->refit->drop, context.options);
    if (!left) {
      out.at = e;
      return out;
    }
    e->candidate.why = "lack of fit remains: with it in the model an unknown " + left->port + "(" + left->quantity + ") still has " +
                       p_equals(left->p_value);
    if (aliases.empty()) out.remaining = left;
    aliases.push_back(e);
    read.insert(read.end(), candidate_model.quantities.begin(), candidate_model.quantities.end());
  }
  for (const auto e : aliases) {
    out.next = explaining_effect(*e, ranked, context);
    if (out.next == nullptr) continue;
    out.at = e;
    return out;
  }
  return out;
}

}  // namespace

std::optional<UnknownCurve> accept_best(std::vector<RankedCandidate>& ranked, const SearchContext& context) {
  const Selection selection = select(ranked, context);
  if (selection.at == ranked.end()) {
    find_groups(ranked, context);
    if (selection.remaining || ranked.empty()) return selection.remaining;
    const RankedCandidate& best = ranked.front();
    if (!best.refit || !(best.candidate.p_value < context.options.p_accept)) return std::nullopt;
    return remaining_lack_of_fit(best.refit->estimate, *best.screening->candidate_model, best.refit->drop, context.options);
  }
  Candidate& c = selection.at->candidate;
  c.accepted = true;
  c.why = "family-wise " + p_equals(c.p_value) + ", held-out gain " + format_value(*c.held_out_gain);
  if (selection.next != nullptr) c.why += "; " + label(selection.next->candidate) + " explains what remains";
  std::rotate(ranked.begin(), selection.at, selection.at + 1);
  find_groups(ranked, context);
  explain_others(ranked);
  return std::nullopt;
}

}  // namespace misfit
