#include "misfit/discover/accept.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/text.h"
#include "misfit/discover/likeness.h"
#include "misfit/discover/verdict.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double tie = 6.0;  // refitted drops nearer than this do not tell two effects apart

std::string named(const Candidate& c) { return effect_at(c.effect, c.roles); }

/// Scores of other effects in the model that holds a refitted one.
class After {
 public:
  After(const Refit& in, const Searched& searched)
      : in_(in), list_(specimens(in.estimate, in.request, searched.registry, searched.options.calibration)), score_(in.estimate) {}

  /// At the effect's best cell of the first search; dof 0 where the model describes it already, no value where it cannot be run with it.
  [[nodiscard]] std::optional<Screened> score(const Entry& other) const {
    Screened out;
    const auto specimen = std::find_if(list_.begin(), list_.end(), [&](const Specimen& s) {
      return s.effect == other.candidate.effect && s.roles == other.candidate.roles;
    });
    if (specimen == list_.end()) return std::nullopt;
    out.specimen = &*specimen;
    out.cell = other.screened->cell;
    out.cells_effective = other.screened->cells_effective;
    CellScore cell = score_cell(in_.estimate, score_, *specimen, out.cell);
    if (cell.columns.size() == 0) return std::nullopt;
    out.result = std::move(cell.result);
    out.columns = std::move(cell.columns);
    out.log_p = log_score_tail(*specimen, out.result.chi2) + std::log(out.cells_effective);
    return out;
  }

 private:
  const Refit& in_;
  std::vector<Specimen> list_;
  ScoreTest score_;
};

/// Once the refitted effect is in, has `other` no significant score? Not so where the two cannot be in one model: that says nothing.
bool adds_nothing(const After& in, const Entry& other, double p_accept) {
  const auto found = in.score(other);
  return found && (found->result.dof == 0 || !(chi_square_tail(found->result.chi2, found->result.dof) < p_accept));
}

/// The other known effect with the least likely score in the model that holds `in`, be it silent before, if it is significant there.
struct Second {
  const Entry* entry = nullptr;
  Screened score;
};
Second second_after(const Entry& in, const After& after, const std::vector<Entry>& entries, double p_accept) {
  Second best;
  for (const Entry& other : entries) {
    if (&other == &in || !other.screened->runs || other.candidate.described || other.candidate.family == "sensor") continue;
    auto found = after.score(other);
    if (!found || found->result.dof == 0 || (best.entry != nullptr && found->log_p >= best.score.log_p)) continue;
    best = {&other, std::move(*found)};
  }
  if (best.entry != nullptr && sidak(std::min(1.0, std::exp(best.score.log_p)), static_cast<double>(entries.size())) > p_accept)
    best.entry = nullptr;
  return best;
}

/// Is `in` still needed beside the other? 2 [log L(both) − log L(other alone)], as any refitted drop family-wise.
bool needed_beside(const Entry& in, const Refit& both, const Entry& other, const Searched& searched) {
  std::optional<Refit> fitted;
  if (!other.refit) fitted = refit(searched.estimate, searched.experiments, *other.screened, searched.registry, searched.options.threads);
  const Refit& alone = other.refit ? *other.refit : *fitted;
  if (!alone.ok || !alone.estimate.converged) return false;
  const double drop = in.refit->drop + both.drop - alone.drop;
  const double log_p = log_score_tail(*in.screened->specimen, drop) + std::log(in.screened->cells_effective);
  return sidak(std::min(1.0, std::exp(log_p)), searched.families) < searched.options.p_accept;
}

Specimen with_quantities(Specimen specimen, const std::vector<int>& quantities) {
  specimen.quantities.insert(specimen.quantities.end(), quantities.begin(), quantities.end());
  return specimen;
}

/// Another known effect with which nothing remains after `in`.
const Entry* known_for(const Entry& in, const std::vector<Entry>& entries, const Searched& searched) {
  const DiscoverOptions& options = searched.options;
  const After after(*in.refit, searched);
  const Second second = second_after(in, after, entries, options.p_accept);
  if (second.entry == nullptr) return nullptr;
  const Refit both = refit(in.refit->estimate, searched.experiments, second.score, searched.registry, options.threads);
  if (!both.ok || !both.estimate.converged || !(both.drop > 0.0)) return nullptr;
  const Model& model = both.estimate.model;
  const std::vector<int>&strengths = in.screened->specimen->strengths, &others = second.score.specimen->strengths;
  if (ends_at_bound(model, strengths) || ends_at_bound(model, others)) return nullptr;
  if (!needed_beside(in, both, *second.entry, searched)) return nullptr;
  // Measured against the drop of `in` alone, as what it left by itself was: the second is called in to explain just that remainder, and
  // the better it does the less may be left, not the more.
  const Specimen reads = with_quantities(*second.score.specimen, in.screened->specimen->quantities);
  return what_is_left(both.estimate, reads, in.refit->drop, options) ? nullptr : second.entry;
}

/// Why it cannot be accepted by itself; empty: it can, and holds out.
std::string refusal(Entry& e, const Searched& searched) {
  Candidate& c = e.candidate;
  if (!(c.p_value < searched.options.p_accept)) return "not significant: family-wise p " + format_probability(c.p_value);
  if (!e.refit->estimate.converged) return "its refit has not converged: " + e.refit->estimate.message;
  if (const auto bound = ends_at_bound(e.refit->estimate.model, e.screened->specimen->strengths)) return *bound;
  c.held_out_gain = held_out_gain(searched.estimate, e.refit->estimate, searched.experiments, searched.options.threads);
  return *c.held_out_gain > 0.0 ? "" : "the held-out likelihood does not rise (" + format_value(*c.held_out_gain) + ")";
}

/// Groups the front with what cannot be told from it.
void find_groups(std::vector<Entry>& entries, const Searched& searched) {
  if (entries.empty() || !entries.front().refit) return;
  Entry& best = entries.front();
  std::vector<Entry*> members = {&best};
  const After after_best(*best.refit, searched);
  const double p_accept = searched.options.p_accept;
  for (std::size_t k = 1; k < entries.size(); ++k) {
    Entry& other = entries[k];
    if (!other.refit || std::abs(other.refit->drop - best.refit->drop) > tie) continue;
    if (!adds_nothing(after_best, other, p_accept) || !adds_nothing(After(*other.refit, searched), best, p_accept)) continue;
    members.push_back(&other);
  }
  if (members.size() < 2) return;
  std::vector<std::string> group;
  for (const Entry* e : members) group.push_back(named(e->candidate));
  for (Entry* e : members) e->candidate.group = group;
}

/// Words for those that were refitted and are not accepted, the accepted one in front.
void tell_others(std::vector<Entry>& entries) {
  const Candidate& best = entries.front().candidate;
  for (std::size_t k = 1; k < entries.size(); ++k) {
    Candidate& other = entries[k].candidate;
    if (!other.why.empty() || !entries[k].refit) continue;
    const bool alike = std::find(other.group.begin(), other.group.end(), named(best)) != other.group.end();
    const bool more = entries[k].refit->drop > entries.front().refit->drop;
    other.why = alike  ? "these data cannot tell it from " + named(best)
                : more ? "with all that it frees less significant than " + named(best) + "; screened again once that is in"
                       : "explains less than " + named(best) + "; screened again once that is in";
  }
}

/// What was found on the way through the list.
struct Choice {
  std::vector<Entry>::iterator at;        ///< of what is accepted, or the end
  const Entry* next = nullptr;            ///< what explains what it leaves, where it leaves something
  std::optional<UnknownCurve> remaining;  ///< after the first that holds out
};

Choice choose(std::vector<Entry>& entries, const Searched& searched) {
  Choice out{entries.end(), nullptr, std::nullopt};
  std::vector<std::vector<Entry>::iterator> likenesses;
  std::vector<int> read;  // by the likenesses
  for (auto e = entries.begin(); e != entries.end() && e->refit; ++e) {
    e->candidate.why = refusal(*e, searched);
    if (!e->candidate.why.empty()) continue;
    const Specimen& specimen = *e->screened->specimen;
    const auto left = what_is_left(e->refit->estimate, with_quantities(specimen, read), e->refit->drop, searched.options);
    if (!left) {
      out.at = e;
      return out;
    }
    e->candidate.why = "most of the departure remains: after it an unknown " + left->port + "(" + left->quantity + ") still has p " +
                       format_probability(left->p_value);
    if (likenesses.empty()) out.remaining = left;
    likenesses.push_back(e);
    read.insert(read.end(), specimen.quantities.begin(), specimen.quantities.end());
  }
  for (const auto e : likenesses) {
    out.next = known_for(*e, entries, searched);
    if (out.next == nullptr) continue;
    out.at = e;
    return out;
  }
  return out;
}

}  // namespace

std::optional<UnknownCurve> accept_best(std::vector<Entry>& entries, const Searched& searched) {
  const Choice choice = choose(entries, searched);
  if (choice.at == entries.end()) {
    find_groups(entries, searched);
    if (choice.remaining || entries.empty()) return choice.remaining;
    const Entry& best = entries.front();
    if (!best.refit || !(best.candidate.p_value < searched.options.p_accept)) return std::nullopt;
    return what_is_left(best.refit->estimate, *best.screened->specimen, best.refit->drop, searched.options);
  }
  Candidate& c = choice.at->candidate;
  c.accepted = true;
  c.why = "family-wise p " + format_probability(c.p_value) + ", held-out gain " + format_value(*c.held_out_gain);
  if (choice.next != nullptr) c.why += "; what remains after it, " + named(choice.next->candidate) + " explains";
  std::rotate(entries.begin(), choice.at, choice.at + 1);
  find_groups(entries, searched);
  tell_others(entries);
  return std::nullopt;
}

}  // namespace misfit
