// discover --auto: rungs are added while something is accepted, or explains most of what is missing, and effects that later ones have made
// needless leave.

#include <fmt/format.h>

#include <algorithm>

#include "misfit/core/display.h"
#include "misfit/core/error.h"
#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/data/candidates.h"
#include "misfit/fit/filter/k_step.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/model/provisional.h"
#include "misfit/model/whole_steps.h"
#include "misfit/workflow/assess/assess.h"
#include "misfit/workflow/assess/without.h"
#include "misfit/workflow/estimate/estimate.h"
#include "misfit/workflow/ladder.h"
#include "misfit/workflow/ladder_candidates.h"

namespace misfit {
namespace {

/// An effect on the ladder, as the last model calls it, and those that explained nearly as much when it was chosen.
struct OnLadder {
  int rung = 0;
  std::string name;
  Candidate from;
  std::vector<Candidate> alternatives;
  bool width_freed = false;
  bool may_be_finer = true;  ///< of a curve of unknown form: with more knots
  int searched_with = -1;    ///< of a curve of unknown form: the last rung beside which a named effect was looked for in its place
};

/// It fixes nothing that the model does not have: what it fixed may have left with another effect.
Candidate as_in(const Session& session, Candidate candidate) {
  const Model model = provisional_model(session.model.request, session.registry);
  std::erase_if(candidate.fixed_in_model, [&](const auto& held) {
    return std::none_of(model.parameters.begin(), model.parameters.end(), [&](const Parameter& p) { return p.name == held.first; });
  });
  return candidate;
}

std::string in_words(const std::string& name, const Without& without, double families) {
  return fmt::format("{} is no longer significant beside what was added after it (a drop of {}, among {:g} that were tried)", name,
                     format_value(without.drop), families);
}

class Extension {
 public:
  Extension(ModelLadder& ladder, const Registry& registry, const LadderListener& listener)
      : ladder_(ladder), registry_(registry), listener_(listener) {}

  void run() {
    constexpr int most_rungs = 12;
    ladder_.limit_fits();
    for (int k = 0; k < most_rungs; ++k) {
      const Discovery discovery = search();
      const std::optional<Candidate> next = accepted_candidate(discovery, registry_);
      if (next && has_left(*next)) break;
      if (is_of_a_hold(next, discovery)) break;
      if (next && !add(*next, alternatives_to(*next, discovery))) {
        ladder_.gained_too_little(effect_at(next->effect, next->roles), why_off_);
        break;
      }
      if (!next && !begin_with_one(discovery) && !begin_with_two(discovery) && !add_curve(discovery) && !begin_after_the_curve(discovery))
        break;
      while (one_leaves() || one_is_exchanged() || one_is_sharper() || one_is_named()) {
      }
    }
    ladder_.last_rung();
    ladder_.compare_free_runs();
    say_needless();
  }

 private:
  /// What the last rung could be missing.
  Discovery search() {
    Discovery out = discovered(ladder_.last());
    if (listener_.discovered) listener_.discovered(out);
    families_ = static_cast<double>(out.candidates.size());
    return out;
  }

  /// The next rung would stand for an input that is held otherwise between its samples than the model says: that is to be mended first,
  /// since what is found beside it may stand for it, too.
  [[nodiscard]] static bool is_of_a_hold(const std::optional<Candidate>& next, const Discovery& discovery) {
    const Candidate* candidate = next ? &*next : candidate_to_begin_with(discovery);
    return candidate != nullptr && candidate->holds.has_value();
  }

  [[nodiscard]] bool has_left(const Candidate& candidate) const {
    return std::any_of(left_.begin(), left_.end(),
                       [&](const Candidate& c) { return c.effect == candidate.effect && c.roles == candidate.roles; });
  }

  /// Is the last effect one of whole steps? That is seen in the measurements: what is held out tells nothing of it, but what else is
  /// missing.
  [[nodiscard]] static bool reads_steps(const Session& session) {
    const Model model = provisional_model(session.model.request, session.registry);
    return !model.effects.empty() && reads_whole_steps(model, model.effects.back());
  }

  /// Whether the free run is asked about a rung at once, or by the caller: what needs another effect beside it may be worse by itself.
  enum class FreeRun { now, later };

  /// False: the rung gains too little once it is fitted, or its free run is worse, as why_off_ says, and is off again.
  bool add(const Candidate& candidate, std::vector<Candidate> alternatives, FreeRun free_run = FreeRun::now) {
    const Rung& rung = ladder_.add(candidate.effect, candidate);
    if (listener_.added) listener_.added(rung);
    if (rung.actual_drop && !reads_steps(ladder_.last())) {
      why_off_ = why_too_little(rung.actual_drop, rung.held_out_gain, parameters_added(rung), families_);
      if (why_off_.empty()) why_off_ = why_undetermined(rung);
      const bool speaks_for = !why_off_.empty() && free_run_speaks_for(candidate, rung);
      if (why_off_.empty() && free_run == FreeRun::now) why_off_ = ladder_.why_free_run_is_worse();
      if (!why_off_.empty() && !speaks_for) {
        const std::string name = effect_at(candidate.effect, candidate.roles);
        ladder_.root().note(fmt::format("{}: once fitted, {}: its rung is taken off", name, why_off_));
        ladder_.remove(std::to_string(rung.id));
        return false;
      }
    }
    added_.push_back({rung.id, ladder_.last().model.request.effects.back().name, candidate, std::move(alternatives)});
    return true;
  }

  /// What a test accepted in discovery, and whose rung predicts what is held out worse one sample ahead (why_off_), stays where the free
  /// run is clearly better, in what is held out, too. Of what explains no more than chance: no.
  bool free_run_speaks_for(const Candidate& candidate, const Rung& rung) {
    const bool significant = why_too_little(rung.actual_drop, std::nullopt, parameters_added(rung), families_).empty();
    if (!candidate.accepted || !significant) return false;
    const std::string why = ladder_.why_free_run_is_better();
    if (why.empty()) return false;
    ladder_.root().note(fmt::format("{}: once fitted, {}; but {}: it stays", effect_at(candidate.effect, candidate.roles), why_off_, why));
    ladder_.stays_for_free_run(why);
    return true;
  }

  /// Several things are missing, and none explains so much by itself that nothing remains: a rung for the effect that explains most of it,
  /// in whose place one of its alternatives may come when the others are there. False: there is none, or it does not do.
  bool begin_with_one(const Discovery& discovery) {
    const Candidate* candidate = candidate_to_begin_with(discovery);
    if (candidate == nullptr || has_left(*candidate)) return false;
    return add_tentatively(*candidate, alternatives_to(*candidate, discovery));
  }

  /// Two things are missing, and one that is right one sample ahead predicts worse farther ahead without the other: both become rungs where
  /// with both nothing predicts worse than without. False: there is no such one, or nothing that does this.
  bool begin_with_two(const Discovery& discovery) {
    const Candidate* first = candidate_short_ahead(discovery);
    if (first == nullptr || has_left(*first)) return false;
    if (can_be_added(*first, {}, FreeRun::later) && holds_beside_another(*first, first->why)) return true;
    ladder_.gained_too_little(effect_at(first->effect, first->roles), why_off_);
    return false;
  }
  /// Of the last rung's, which by itself is refused for `why`. False: its rung is off again.
  bool holds_beside_another(const Candidate& first, const std::string& why) {
    const std::string name = effect_at(first.effect, first.roles);
    const Rung alone = ladder_.ladder().rungs.back(), without = rung_of(alone.parent);
    ladder_.root().note(name + " predicts worse farther ahead by itself: it stays if something else is missing beside it that mends this");
    try {
      if (add_beside(name, without)) return true;
    } catch (...) {  // an interrupt, a limit of time
      ladder_.remove(std::to_string(alone.id));
      throw;
    }
    why_off_ = "by itself, " + why + ", and nothing was found that mends this";
    ladder_.root().note(name + ": " + why_off_ + ": its rung is taken off");
    take_off_last();
    return false;
  }
  /// The first effect, of those that may be missing beside the last rung's, with which predictions are no worse than `without` both.
  bool add_beside(const std::string& name, const Rung& without) {
    for (const Candidate& second : candidates_beside(search())) {
      if (has_left(second) || !can_be_added(second)) continue;
      const double growth = largest_growth(without, ladder_.ladder().rungs.back());
      if (!(growth > 1.0)) return true;
      ladder_.root().note(fmt::format("with {} and {} {}: the rung of the latter is taken off", name,
                                      effect_at(second.effect, second.roles), growth_in_words(growth)));
      take_off_last();
    }
    return false;
  }

  /// A curve of unknown form was added in vain: the effect that explains most beside it becomes a rung, where by itself it predicts worse
  /// farther ahead with another one, as in begin_with_two(). False: no curve was fitted, or that does not do.
  bool begin_after_the_curve(const Discovery& discovery) {
    if (!curve_in_vain_) return false;
    const std::optional<Candidate> first = candidate_after_the_curve(discovery);
    if (!first || has_left(*first) || !can_be_added(*first, alternatives_to(*first, discovery), FreeRun::later)) return false;
    std::string why = why_not_kept(ladder_.ladder().rungs.back());
    if (why.empty()) why = ladder_.why_free_run_is_worse();
    return why.empty() || holds_beside_another(*first, why);
  }

  void take_off_last() {
    ladder_.remove(std::to_string(ladder_.ladder().rungs.back().id));
    added_.pop_back();
  }

  /// A force or an error of unknown form becomes a rung as it is: a curve of the quantity that it depends on. What else is missing can then
  /// be found beside it. False: there is none, or it gains nothing.
  bool add_curve(const Discovery& discovery) {
    curve_in_vain_ = false;
    if (!discovery.unexplained_effects.empty() && lacks_pulses_only(ladder_.last()))
      return false;  // where they happened to be is no reason
    return std::any_of(discovery.unexplained_effects.begin(), discovery.unexplained_effects.end(),
                       [this](const EffectPlace& place) { return add_curve(place); });
  }
  bool add_curve(const EffectPlace& place) {
    const auto& [effect, roles] = place;
    const auto& own = ladder_.last().model.request.effects;
    if (std::any_of(own.begin(), own.end(),
                    [&, kind = effect, at = roles](const EffectRequest& e) { return e.kind == kind && e.roles == at; }))
      return refine_curve(effect, roles);  // its knots are too far apart for what is left, or its place is another
    const std::optional<Candidate> curve = predict_effect(ladder_.last(), effect, {roles});
    if (!curve || has_left(*curve)) return false;
    if (add_tentatively(*curve, {})) return true;
    curve_in_vain_ = was_fitted_;
    ladder_.gained_too_little(effect_at(effect, roles), why_off_);
    return false;
  }

  /// The curve that is on the ladder again with twice as many knots, where it then explains clearly more of the fitted data and no less of
  /// what is held out; else as it was. False: that is known, or it was not added here.
  bool refine_curve(const std::string& effect, const std::map<std::string, std::string>& roles) {
    constexpr double clearly = 10.0, for_each_knot = 1.0;
    const auto on =
        std::find_if(added_.begin(), added_.end(), [&](const OnLadder& a) { return a.from.effect == effect && a.from.roles == roles; });
    if (on == added_.end() || !on->may_be_finer) return false;
    const auto k = static_cast<std::size_t>(on - added_.begin());
    const Rung before = rung_of(on->rung);
    Candidate finer = on->from;
    const Candidate coarse = finer;
    const std::vector<double> knots = knots_of(on->name);
    finer.knots = twice_as_many(knots);
    if (finer.knots.empty()) return false;
    const double needed = clearly + for_each_knot * static_cast<double>(finer.knots.size() - knots.size());
    ladder_.root().note(on->name + " once more, with twice as many knots: something is left that depends on the same");
    if (!rebuild_without(k, finer, true)) return true;
    const Rung& after = rung_of(added_[k].rung);
    if (after.loglik > before.loglik + needed && after.validation_loglik.value_or(0.0) >= before.validation_loglik.value_or(0.0))
      return true;
    ladder_.root().note(added_[k].name + ": more knots explain no more: it has those from before");
    if (rebuild_without(k, coarse, true)) added_[k].may_be_finer = false;
    return true;  // what is left beside it is to be said
  }

  [[nodiscard]] const Rung& rung_of(int id) const {
    const auto& rungs = ladder_.ladder().rungs;
    return *std::find_if(rungs.begin(), rungs.end(), [id](const Rung& r) { return r.id == id; });
  }

  /// Of the curve of an effect of the last model [SI].
  [[nodiscard]] std::vector<double> knots_of(const std::string& effect) {
    const Model model = prepare(ladder_.last()).model;
    for (const BoundEffect& bound : model.effects) {
      if (bound.name != effect) continue;
      for (const BoundCoefficient& c : bound.coefficients) {
        if (c.curve >= 0) return model.curves[c.curve].spline.breakpoints();
      }
    }
    return {};
  }

  /// What discovery does not accept as it is. False: it cannot be fitted, or the rung is off again, as why_not_kept says.
  bool add_tentatively(const Candidate& candidate, std::vector<Candidate> alternatives) {
    if (!can_be_added(candidate, std::move(alternatives))) return false;
    why_off_ = why_not_kept(ladder_.ladder().rungs.back());
    if (why_off_.empty()) return true;
    ladder_.root().note(fmt::format("{}: {}: its rung is taken off", effect_at(candidate.effect, candidate.roles), why_off_));
    take_off_last();
    return false;
  }

  /// add(), of what may not be possible to fit.
  bool can_be_added(const Candidate& candidate, std::vector<Candidate> alternatives = {}, FreeRun free_run = FreeRun::now) {
    const std::string name = effect_at(candidate.effect, candidate.roles);
    was_fitted_ = true;
    try {
      return add(candidate, std::move(alternatives), free_run);
    } catch (const InputError& error) {  // what a curve is one of hardly moves in the fit that comes first
      return cannot_be_added(name, error);
    } catch (const RunError& error) {
      stop_if_interrupted();
      return cannot_be_added(name, error);
    }
  }

  bool cannot_be_added(const std::string& name, const std::exception& error) {
    was_fitted_ = false;
    why_off_ = std::string("it cannot be fitted: ") + error.what();
    ladder_.root().note(name + " cannot be fitted: " + error.what());
    return false;
  }

  /// Of a rung that was added tentatively; empty: it stays.
  [[nodiscard]] std::string why_not_kept(const Rung& rung) const {
    const auto parent =
        std::find_if(ladder_.ladder().rungs.begin(), ladder_.ladder().rungs.end(), [&](const Rung& r) { return r.id == rung.parent; });
    if (parent == ladder_.ladder().rungs.end()) return "";
    constexpr double hardly = 1.03, hardly_held_out = 1.05;  // no test has accepted it: nothing may get worse with it
    if (const double growth = growth_of_errors(parent->k_step, rung.k_step); growth > hardly) return growth_in_words(growth);
    if (!parent->validation_k_step || !rung.validation_k_step) return "";
    const double growth = growth_of_errors(*parent->validation_k_step, *rung.validation_k_step);
    return growth > hardly_held_out ? "of what is held out, " + growth_in_words(growth) : "";
  }

  /// The first that the later ones have made needless goes, and those above it are added again without it. False: there is none.
  bool one_leaves() {
    for (std::size_t k = 0; k + 1 < added_.size(); ++k) {
      const auto without = needless(ladder_.last(), added_[k].name, families_);
      if (!without) continue;
      ladder_.root().note(in_words(added_[k].name, *without, families_) + ": it leaves the ladder");
      return rebuild_without(k, std::nullopt);
    }
    return false;
  }

  /// The first in whose place one of its alternatives explains more, now that the later ones are there, makes room for it. False: there is
  /// none.
  bool one_is_exchanged() {
    constexpr double clearly = 10.0;  // as far apart as effects that data can distinguish, and for each parameter more
    for (std::size_t k = 0; k + 1 < added_.size(); ++k) {
      std::vector<Candidate> others = std::move(added_[k].alternatives);
      added_[k].alternatives.clear();  // asked once
      std::erase_if(others, [this](const Candidate& c) { return has_left(c); });
      const auto without = others.empty() ? std::nullopt : model_without(ladder_.last(), added_[k].name);
      if (!without) continue;
      for (const Candidate& other : others) {
        const auto there = in_its_place(ladder_.last(), *without, other);
        if (!there) continue;
        const auto more =
            static_cast<double>(std::max<std::ptrdiff_t>(std::ssize(there->parameters) - std::ssize(added_[k].from.parameters), 0));
        if (!(*there->actual_drop > without->drop + clearly * (1.0 + more))) continue;
        ladder_.root().note(fmt::format("beside what was added after it, {} explains more (drop {}) than {} (drop {}): it takes its place",
                                        effect_at(other.effect, other.roles), format_value(*there->actual_drop), added_[k].name,
                                        format_value(without->drop)));
        return rebuild_without(k, there);
      }
    }
    return false;
  }

  /// The first whose width was fixed at what the filter could resolve before it, and the later ones, were there, and which has another one
  /// now, gets that: fixed at the wrong one, an effect makes room for others that are not there. False: there is none.
  bool one_is_sharper() {
    for (std::size_t k = 0; k < added_.size(); ++k) {
      if (added_[k].width_freed) continue;
      const auto width = width_of(ladder_.last(), added_[k].name);
      if (!width || may_be_chance(width->drop, 1, families_)) continue;
      const auto known = added_[k].from.parameters.find(width->coefficient);
      if (known == added_[k].from.parameters.end()) continue;
      ladder_.root().note(fmt::format("{}, {} of {} is {} (drop {}): estimated from here on",
                                      k + 1 < added_.size() ? "beside what was added after it" : "with it in the model", width->coefficient,
                                      added_[k].name, in_display_unit(width->value, known->second.unit), format_value(width->drop)));
      Candidate again = added_[k].from;
      again.parameters[width->coefficient].value = width->value;
      std::erase(again.fixed, width->coefficient);
      again.free.push_back(width->coefficient);
      return rebuild_without(k, again, true);
    }
    return false;
  }

  /// A curve of unknown form stands in for an effect that could not be named among all that was missing then. With what was added after it
  /// in the model, the search is made once more without it: an effect that is accepted there takes its place. False: there is none.
  bool one_is_named() {
    for (std::size_t k = 0; k + 1 < added_.size(); ++k) {
      const bool unknown = registry_.effect(added_[k].from.effect).spec().has_unknown_form();
      if (!unknown || added_[k].searched_with == added_.back().rung) continue;
      added_[k].searched_with = added_.back().rung;
      const auto without = model_without(ladder_.last(), added_[k].name);
      if (!without) continue;
      const std::optional<Candidate> named = accepted_candidate(search_without(ladder_.last(), *without), registry_);
      if (!named || has_left(*named)) continue;
      ladder_.root().note(fmt::format("beside what was added after it, {} stands for {}: it takes its place",
                                      effect_at(named->effect, named->roles), effect_at(added_[k].from.effect, added_[k].from.roles)));
      return rebuild_without(k, named);
    }
    return false;
  }

  /// The ladder from the rung of added_[k] on once more: `instead` in its place, or nothing, then those above it. False: one of them gains
  /// nothing now, or cannot be fitted; the ladder then ends below it, and the search goes on from there.
  bool rebuild_without(std::size_t k, const std::optional<Candidate>& instead, bool same_effect = false) {
    if (!same_effect) left_.push_back(added_[k].from);
    const std::vector<OnLadder> above(added_.begin() + k + 1, added_.end());
    ladder_.remove(std::to_string(added_[k].rung));
    added_.resize(k);
    try {
      if (instead && !add(without_refit(*instead), {}, FreeRun::later)) return false;
      if (same_effect) added_.back().width_freed = true;
      for (const OnLadder& again : above) {
        if (!add(as_in(ladder_.last(), without_refit(again.from)), again.alternatives, FreeRun::later)) return false;
      }
    } catch (const InputError& error) {  // it needs what has left
      return cannot_be_fitted_again(error);
    } catch (const RunError& error) {
      return cannot_be_fitted_again(error);
    }
    return true;
  }
  bool cannot_be_fitted_again(const std::exception& error) {
    ladder_.root().note(std::string("a rung could not be fitted again: ") + error.what());
    return false;
  }

  /// Effects that somebody added by hand are not taken off, but it is said.
  void say_needless() {
    for (const Rung& rung : ladder_.ladder().rungs) {
      if (rung.id == ladder_.ladder().rungs.back().id) break;  // nothing was added after it
      const bool own = std::any_of(added_.begin(), added_.end(), [&](const OnLadder& a) { return a.rung == rung.id; });
      const auto& effects = ladder_.last().model.request.effects;
      const auto bound = std::find_if(effects.begin(), effects.end(), [&](const EffectRequest& e) {
        return e.kind == rung.added && e.roles == rung.roles.value_or(std::map<std::string, std::string>{});
      });
      if (rung.parent < 0 || own || bound == effects.end()) continue;
      if (const auto without = needless(ladder_.last(), bound->name, families_))
        ladder_.root().note(in_words(bound->name, *without, families_) +
                            fmt::format(": `misfit remove` of rung {} takes it and those above it off", rung.id));
    }
  }

  ModelLadder& ladder_;
  const Registry& registry_;
  const LadderListener& listener_;
  std::vector<OnLadder> added_;
  std::vector<Candidate> left_;
  double families_ = 1.0;       ///< that the last round tried
  std::string why_off_;         ///< why what was added last is off again: a clause
  bool was_fitted_ = true;      ///< what was added last
  bool curve_in_vain_ = false;  ///< of this round: a curve of unknown form was fitted and is off again
};

}  // namespace

void extend_ladder(ModelLadder& ladder, const Registry& registry, const LadderListener& listener) {
  Extension(ladder, registry, listener).run();
}

}  // namespace misfit
