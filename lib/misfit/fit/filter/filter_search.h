#pragma once

#include <Eigen/Dense>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "misfit/core/watch.h"
#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/fit/filter/first_noise.h"
#include "misfit/fit/filter/likelihood_ascent.h"
#include "misfit/fit/filter/likelihood_derivatives.h"
#include "misfit/fit/filter/other_weights.h"
#include "misfit/fit/filter/restricted_likelihood.h"
#include "misfit/math/bfgs.h"

// Of estimate_filter(): not for use outside.
namespace misfit {

/// Where a search ended, the model diverges in what is held out, which its runs left out.
struct DivergesWhereHeldOut {};

/// One search for the maximum, from one start: the steps of estimate_filter().
class FilterSearch {
 public:
  FilterSearch(const FilterStart& start, const std::vector<Signals>& experiments, const FilterOptions& options)
      : options_(options),
        noise_given_(start.noise || options.noise),
        at_(start.model, start.penalties, experiments, with_noise_of(start, options)) {}

  /// What becomes of a start from which the model cannot be run.
  enum class Unrunnable { replaced, refused };

  /// As far as the first rounds of the blocks in turn. RunError: the model cannot be run from its start, or from none in its place.
  void approach(int rounds, Unrunnable unrunnable = Unrunnable::replaced);

  /// The same from a free run (free_approach.h). RunError: the model cannot be run so.
  void approach_freely(int rounds);

  /// On to the end. RunError: the model cannot be run where it ended.
  void finish();

  /// Ends where the search was when its time was spent, not converged. False: it had come to no point yet.
  bool cut_off(const TimeLimitReached& spent);
  /// [log-likelihood] Objective of the point to which cut_off() would return.
  [[nodiscard]] double reached() const { return at_.reached(); }

  /// What was wrong with the start; empty: it is the given one.
  [[nodiscard]] const std::string& replaced() const { return replaced_; }

  FilterEstimate take() { return std::move(out_); }

  /// [log-likelihood] By which starts of one model are compared (marginal_loglik), parameters and noise as they are.
  [[nodiscard]] double height() const { return height_of(at_); }
  /// Below which it does not end; −infinity where the start is none (set_floor()).
  [[nodiscard]] double floor() const { return floor_ ? floor_->objective : -std::numeric_limits<double>::infinity(); }

  static constexpr int all_rounds = 25;

 private:
  /// The options with the noise that a start brings.
  static FilterOptions with_noise_of(const FilterStart& start, FilterOptions options);

  /// [log-likelihood] Coarse where refine_jointly() follows.
  [[nodiscard]] double tolerance() const { return options_.verify ? 0.2 : 0.02; }

  void plan_first();
  void iterate_first(int rounds);

  /// The model can be run: with the noise raised, in finer steps, or from another start. RunError: from none.
  void make_runnable(Unrunnable unrunnable);

  /// A filter whose assumed noise is too small diverges: noise is raised until the RMS of the whitened innovations is at most 2.
  bool runs_with_raised_noise();

  /// A motion that the steps of a search lose may be followed in finer ones.
  bool runs_finely(const FilterNoise& noise);

  /// Where noise, measurements and roughness are given, the end is compared with the start: of two models each is to end at its maximum on
  /// the same, and the larger one never below the smaller one from which it began.
  void set_floor();

  /// A noise step may lose a little, and the noise's restricted likelihood has its maximum elsewhere: an end below the start is replaced by
  /// what plain Newton steps, each of which rises, reach from the start.
  void return_to_floor();

  [[nodiscard]] double innovation_variance() const;

  /// The likelihood has a maximum per correlation time at which the random force can stand in for something else (coloured noise, the
  /// motion's own memory): the search goes on from the highest, others nearly as high are named.
  void survey_noise();

  /// Gates the measurements and estimates again until the rejected set no longer changes: outliers in the data bias the first estimates, by
  /// which good measurements may have been rejected too. Those at the jumps of an input are kept.
  void reject_outliers();

  /// Memories begin where the values that the search starts from say that they are: where those that it has come to say something else,
  /// it goes on with that.
  void begin_memories_anew();

  /// After a change of which measurements count.
  void iterate_again();

  /// Newton steps over parameters and log noise together (lib/misfit/README.md, 5.7, step 6). Ends when no step rises, not even along the
  /// axes of the correlation matrix (step_along_axes(), where a step promised little, twice at most: each costs about as much as a Newton
  /// step), or after a step of less than a sigma.
  void refine_jointly();
  /// Even a multiple of the promised gain does not lead to FilterOptions::least.
  [[nodiscard]] bool is_hopeless(double promised) const;

  bool differentiate(bool one_sided, LikelihoodDerivatives& exact);

  /// Plans the integration anew where its error moves an estimate by more than a tenth of its sigma, and estimates again.
  void integrate_well();

  void describe_integration(int plans, double shift);
  bool exclude_nonlinear(const std::vector<std::vector<std::size_t>>& nonlinear);

  /// −½ log det N is nearly linear in the logarithms of the noise: its gradient is reused until one of these has changed by 0.1.
  void restrict_likelihood();

  /// The information loss is an approximation: it is not subtracted where the matrix would not stay positive definite.
  bool invert_joint(const LikelihoodDerivatives& exact);

  /// With the BFGS inverse of the steps before; if that does not rise (near a kink its updates are wrong), with the inverse information.
  std::optional<double> step_jointly(const LikelihoodDerivatives& exact);

  /// No step that the derivatives propose rises as it promised. False: none along the axes rises by what a sigma is worth either, so that
  /// this is a maximum, at a kink.
  bool step_along_axes();

  void conclude();
  void set_covariance();
  [[nodiscard]] std::string how_it_ended() const;

  /// Where a comparison begins.
  struct Floor {
    Eigen::VectorXd theta;
    std::vector<double> logs;
    double objective;
  };

  FilterOptions options_;
  bool noise_given_;  ///< by the caller or the start: not searched for at first
  std::string replaced_;
  int rounds_left_ = all_rounds;
  bool at_kink_ = false;
  std::optional<Floor> floor_;
  BfgsInverse bfgs_;
  RestrictedLikelihood restricted_;
  std::vector<double> restricted_at_;  ///< the logarithms where it was taken
  std::string unverified_ = "too many samples where the linearisation of the filter fails";
  LikelihoodAscent at_;
  FilterEstimate& out_ = at_.out;
};

}  // namespace misfit
