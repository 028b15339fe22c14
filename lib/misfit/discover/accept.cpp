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

/// Scores of other effects in the model that holds a refitted one.
class After {
 public:
  After(const Refit& in, const Searched& searched)
      : in_(in), list_(specimens(in.estimate, in.request, searched.registry, searched.options.calibration)), score_(in.estimate) {}

  /// At the effect's best cell of the first search; no value: it has none here.
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
    if (cell.columns.size() == 0 || cell.result.dof == 0) return std::nullopt;
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

/// Has `other` a significant score in the model that holds the refitted effect?
bool adds_to(const After& in, const Entry& other, double p_accept) {
  const auto found = in.score(other);
  return found && chi_square_tail(found->result.chi2, found->result.dof) < p_accept;
}

/// Another known effect with which nothing remains after `in`, be it silent before: the one with the least likely score in the model that
/// holds `in`, if a refit with both leaves no dependence worth a good part of their drops.
const Entry* known_for(const Entry& in, const std::vector<Entry>& entries, const Searched& searched) {
  const After after(*in.refit, searched);
  const Entry* next = nullptr;
  std::optional<Screened> best;
  for (const Entry& other : entries) {
    if (&other == &in || !other.screened->runs || other.candidate.described || other.candidate.family == "sensor") continue;
    auto found = after.score(other);
    if (!found || (best && found->log_p >= best->log_p)) continue;
    best = std::move(found);
    next = &other;
  }
  if (!best || sidak(std::min(1.0, std::exp(best->log_p)), static_cast<double>(entries.size())) > searched.options.p_accept) return nullptr;
  const Refit both = refit(in.refit->estimate, searched.experiments, *best, searched.registry, searched.options.threads);
  if (!both.ok || !(both.drop > 0.0)) return nullptr;
  Specimen reads = *best->specimen;
  reads.quantities.insert(reads.quantities.end(), in.screened->specimen->quantities.begin(), in.screened->specimen->quantities.end());
  return what_is_left(both.estimate, reads, in.refit->drop + both.drop, searched.options) ? nullptr : next;
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
    const bool alike = std::find(other.group.begin(), other.group.end(), named(best)) != other.group.end();
    other.why =
        alike ? "these data cannot tell it from " + named(best) : "explains less than " + named(best) + "; screened again once that is in";
  }
}

}  // namespace

void find_groups(std::vector<Entry>& entries, const Searched& searched) {
  if (entries.empty() || !entries.front().refit) return;
  Entry& best = entries.front();
  std::vector<Entry*> members = {&best};
  const After after_best(*best.refit, searched);
  const double p_accept = searched.options.p_accept;
  for (std::size_t k = 1; k < entries.size(); ++k) {
    Entry& other = entries[k];
    if (!other.refit || std::abs(other.refit->drop - best.refit->drop) > tie) continue;
    if (adds_to(after_best, other, p_accept) || adds_to(After(*other.refit, searched), best, p_accept)) continue;
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
  auto left = what_is_left(best.refit->estimate, *best.screened->specimen, best.refit->drop, searched.options);
  if (!holds_out) return left;
  Candidate& c = best.candidate;
  const Entry* next = left ? known_for(best, entries, searched) : nullptr;
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
