#include "misfit/discover/discover.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/text.h"
#include "misfit/core/units.h"
#include "misfit/diagnose/features.h"
#include "misfit/discover/candidate.h"
#include "misfit/discover/likeness.h"
#include "misfit/discover/refit.h"
#include "misfit/discover/screen.h"
#include "misfit/discover/verdict.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double tie = 6.0;  // refitted drops nearer than this do not tell two effects apart (DESIGN 6)

class Search {
 public:
  Search(const FilterEstimate& estimate, const ModelRequest& request, const Registry& registry, const std::vector<Signals>& experiments,
         const DiscoverOptions& options)
      : estimate_(estimate),
        experiments_(experiments),
        registry_(registry),
        options_(options),
        specimens_(specimens(estimate, request, registry, options.calibration)),
        score_(estimate),
        path_(estimate) {}

  Discovery run() {
    screened_ = screen(estimate_, score_, path_, specimens_, options_.threads, part(0.0, end_of_screen));
    unknown_ = unknown_curves(estimate_, score_, path_, options_.threads, part(end_of_screen, end_of_curves));
    families_ = static_cast<double>(screened_.size() + unknown_.size());
    rank();
    refit_best();
    find_groups();
    accept();
    list_unknown();
    describe_search();
    return std::move(out_);
  }

  /// Only the effect of the options, with the drop of one step, as a candidate among all families.
  Discovery predict() {
    const std::size_t curves =
        features_of(estimate_, path_, hats_of_unknown_curves).size() * estimate_.model.system->spec().dynamic_ports.size();
    families_ = static_cast<double>(specimens_.size() + curves);
    std::erase_if(specimens_, [&](const Specimen& s) { return s.effect != options_.only; });
    screened_ = screen(estimate_, score_, path_, specimens_, options_.threads, part(0.0, 1.0));
    rank();
    for (auto& e : entries_) {
      if (e.screened->runs && !e.candidate.described)
        e.candidate.predicted_drop = predicted_drop(estimate_, score_, *e.screened, registry_, options_.threads);
      out_.candidates.push_back(e.candidate);
    }
    return std::move(out_);
  }

 private:
  /// Of the time that a search takes, about: measured on 79 s of flight.
  static constexpr double end_of_screen = 0.45, end_of_curves = 0.5, end_of_refits = 0.9;

  /// Progress of a part of the search that goes from one share of the whole to another.
  ProgressFn part(double from, double to) const {
    if (!options_.progress) return {};
    return [this, from, to](std::size_t done, std::size_t total) {
      constexpr double fine = 1000.0;
      const double share = from + (to - from) * static_cast<double>(done) / static_cast<double>(std::max<std::size_t>(total, 1));
      options_.progress(static_cast<std::size_t>(fine * share), static_cast<std::size_t>(fine));
    };
  }

  struct Entry {
    const Screened* screened = nullptr;
    Candidate candidate;
    std::optional<Refit> refit;
    double log_p = 0.0;  ///< of the refit where there is one
  };

  void rank() {
    for (const auto& s : screened_) {
      Entry entry;
      entry.screened = &s;
      entry.log_p = s.log_p;
      entry.candidate = named_candidate(s, families_);
      entries_.push_back(std::move(entry));
    }
    sort_entries();
  }

  static std::string named(const Candidate& c) { return effect_at(c.effect, c.roles); }

  void sort_entries() {
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      if (a.candidate.described != b.candidate.described) return b.candidate.described;
      if (a.refit.has_value() != b.refit.has_value()) return a.refit.has_value();
      return a.log_p < b.log_p;
    });
  }

  /// All whose predicted drop is above half the best, if the screen says that there is anything.
  void refit_best() {
    double best = 0.0;
    for (const auto& e : entries_) {
      if (!e.candidate.described && e.candidate.p_value < 5.0 * options_.p_accept) best = std::max(best, e.candidate.predicted_drop);
    }
    if (!(best > 0.0)) return;
    const auto worth_it = [&](const Entry& e) {
      return !e.candidate.described && e.candidate.p_value <= 5.0 * options_.p_accept && e.candidate.predicted_drop >= 0.5 * best;
    };
    const auto most = static_cast<std::size_t>(options_.most_refits);
    const std::size_t count = std::min(most, static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(), worth_it)));
    const ProgressFn progress = part(end_of_curves, end_of_refits);
    std::size_t refits = 0;
    for (auto& e : entries_) {
      if (refits >= count) break;
      if (!worth_it(e)) continue;
      e.candidate.predicted_drop = predicted_drop(estimate_, score_, *e.screened, registry_, options_.threads);
      e.refit = refit(estimate_, experiments_, *e.screened, registry_, options_.threads);
      take_refit(e);
      ++refits;
      if (progress) progress(refits, count);
    }
    sort_entries();
  }

  void take_refit(Entry& e) const {
    Candidate& c = e.candidate;
    if (!e.refit->ok) {
      c.why = e.refit->why;
      e.refit.reset();
      return;
    }
    c.actual_drop = e.refit->drop;
    e.log_p = log_chi_square_tail(e.refit->drop, c.dof) + std::log(e.screened->cells_effective);
    c.p_value = sidak(std::min(1.0, std::exp(e.log_p)), families_);
    c.parameters = e.refit->parameters;
    for (int port : e.refit->estimate.forced.force_ports) {
      const PortSpec& named = estimate_.model.system->spec().dynamic_ports[static_cast<std::size_t>(port)];
      c.force[named.name] = {e.refit->estimate.noise.force, 0.0, named.unit};
    }
  }

  /// The best and every other whose refitted drop is near: inseparable if neither has a significant score once the other is in.
  void find_groups() {
    if (entries_.empty() || !entries_.front().refit) return;
    Entry& best = entries_.front();
    std::vector<Entry*> members = {&best};
    for (std::size_t k = 1; k < entries_.size(); ++k) {
      Entry& other = entries_[k];
      if (!other.refit || std::abs(other.refit->drop - best.refit->drop) > tie) continue;
      if (adds_to(*best.refit, other) || adds_to(*other.refit, best)) continue;
      members.push_back(&other);
    }
    if (members.size() < 2) return;
    std::vector<std::string> group;
    for (const Entry* e : members) group.push_back(named(e->candidate));
    for (Entry* e : members) e->candidate.group = group;
  }

  /// Has `other` a significant score in the model that holds the refitted effect?
  bool adds_to(const Refit& in, const Entry& other) const {
    const std::vector<Specimen> list = specimens(in.estimate, in.request, registry_, options_.calibration);
    const auto specimen = std::find_if(list.begin(), list.end(), [&](const Specimen& s) {
      return s.effect == other.candidate.effect && s.roles == other.candidate.roles;
    });
    if (specimen == list.end()) return false;
    const Eigen::MatrixXd columns = specimen_columns(in.estimate, *specimen, other.screened->cell);
    if (columns.size() == 0) return false;
    const ScoreResult result = ScoreTest(in.estimate).test(columns, specimen->has_priors ? &specimen->priors : nullptr);
    return result.dof > 0 && chi_square_tail(result.chi2, result.dof) < options_.p_accept;
  }

  void accept() {
    if (entries_.empty() || !entries_.front().refit) return;
    if (!(entries_.front().candidate.p_value < options_.p_accept)) {
      entries_.front().candidate.why = "not significant: family-wise p " + format_probability(entries_.front().candidate.p_value);
      return;
    }
    if (!first_that_holds_out()) {
      left_ = left_after(entries_.front());
      return;
    }
    Entry& best = entries_.front();
    Candidate& c = best.candidate;
    left_ = left_after(best);
    if (left_) {
      c.why = "most of the departure remains: after it an unknown " + left_->port + "(" + left_->quantity + ") still has p " +
              format_probability(left_->p_value);
      return;
    }
    c.accepted = true;
    c.why = "family-wise p " + format_probability(c.p_value) + ", held-out gain " + format_value(*c.held_out_gain);
    for (std::size_t k = 1; k < entries_.size(); ++k) {
      Candidate& other = entries_[k].candidate;
      if (!other.why.empty() || !entries_[k].refit) continue;
      other.why = !other.group.empty() ? "these data cannot tell it from " + named(c)
                                       : "explains less than " + named(c) + "; screened again once that is in";
    }
  }

  /// Brings to the front the best, or of its group the first, that makes the held-out readings more likely with strengths away from their
  /// bounds; false: none does.
  bool first_that_holds_out() {
    const std::vector<std::string> group = entries_.front().candidate.group;
    for (auto e = entries_.begin(); e != entries_.end(); ++e) {
      Candidate& c = e->candidate;
      const bool in_group = std::find(group.begin(), group.end(), named(c)) != group.end();
      if (!e->refit || (e != entries_.begin() && !in_group)) continue;
      if (const auto bound = ends_at_bound(e->refit->estimate.model, e->screened->specimen->strengths)) {
        c.why = *bound;
        continue;
      }
      c.held_out_gain = held_out_gain(estimate_, e->refit->estimate, experiments_, options_.threads);
      if (*c.held_out_gain > 0.0) {
        std::rotate(entries_.begin(), e, e + 1);
        return true;
      }
      c.why = "the held-out likelihood does not rise (" + format_value(*c.held_out_gain) + ")";
    }
    return false;
  }

  std::optional<UnknownCurve> left_after(const Entry& e) const {
    return what_is_left(e.refit->estimate, *e.screened->specimen, e.refit->drop, options_);
  }

  void list_unknown() {
    for (auto& e : entries_) {
      const std::string p = "family-wise p " + format_probability(e.candidate.p_value);
      if (e.candidate.why.empty()) {
        e.candidate.why = e.candidate.p_value < options_.p_accept
                              ? p + ", but less than half of the best's predicted drop: screened again once that is in"
                              : "not significant: " + p;
      }
      out_.candidates.push_back(e.candidate);
    }
    std::stable_sort(unknown_.begin(), unknown_.end(), [](const UnknownCurve& a, const UnknownCurve& b) { return a.log_p < b.log_p; });
    for (const auto& curve : unknown_) out_.candidates.push_back(unknown_candidate(curve, families_, options_.p_accept));
    rank_candidates(out_.candidates);
  }

  void describe_search() {
    for (int port : estimate_.forced.force_ports) {
      const PortSpec& named = estimate_.model.system->spec().dynamic_ports[static_cast<std::size_t>(port)];
      out_.force[named.name] = {estimate_.noise.force, 0.0, named.unit};
    }
    for (const auto& s : screened_) {
      out_.tried.push_back(effect_at(s.specimen->effect, s.specimen->roles) + " (" + s.specimen->family + "): " + std::to_string(s.cells) +
                           (s.cells == 1 ? " cell" : " cells") + ", " + format_value(std::round(s.cells_effective)) + " effective");
    }
    std::string curves = "unknown curves:";
    for (const auto& curve : unknown_) curves += " " + curve.port + "(" + curve.quantity + ")";
    out_.tried.push_back(curves);
    const std::optional<Unexplained> open = unexplained();
    write_verdict(out_, open, options_.p_accept);
    add_likenesses(screened_, score_, out_);
    add_camera_remarks(options_.calibration, out_);
  }

  /// What depends on a quantity in a way that no named effect has.
  std::optional<Unexplained> unexplained() const {
    if (left_) return Unexplained{left_->port, left_->quantity, left_->p_value};
    if (!out_.candidates.empty() && out_.candidates.front().accepted) return std::nullopt;
    if (unknown_.empty()) return std::nullopt;
    const UnknownCurve& best = unknown_.front();
    const double p = sidak(best.p_value, families_);
    if (!(p < options_.p_accept)) return std::nullopt;
    const bool named_better = !entries_.empty() && entries_.front().refit && entries_.front().log_p < best.log_p;
    if (named_better) return std::nullopt;  // what a known effect explains better is not unknown, though it is not accepted
    return Unexplained{best.port, best.quantity, p};
  }

  const FilterEstimate& estimate_;
  const std::vector<Signals>& experiments_;
  const Registry& registry_;
  DiscoverOptions options_;
  std::vector<Specimen> specimens_;
  ScoreTest score_;
  ForceColumns path_;
  std::vector<Screened> screened_;
  std::vector<UnknownCurve> unknown_;
  std::vector<Entry> entries_;
  std::optional<UnknownCurve> left_;
  double families_ = 1.0;
  Discovery out_;
};

}  // namespace

Discovery discover(const FilterEstimate& estimate, const ModelRequest& request, const Registry& registry,
                   const std::vector<Signals>& experiments, const DiscoverOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Search search(estimate, request, registry, experiments, options);
  Discovery out = options.only.empty() ? search.run() : search.predict();
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

}  // namespace misfit
