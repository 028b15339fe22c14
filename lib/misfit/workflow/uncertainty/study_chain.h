#pragma once

#include <memory>
#include <string>
#include <vector>

#include "misfit/uncertainty/monte_carlo.h"
#include "misfit/workflow/estimate/methods.h"
#include "misfit/workflow/uncertainty/quantities_of_interest.h"
#include "misfit/workflow/uncertainty/rig.h"

namespace misfit {

/// From a perturbed rig to the numbers of a fit: pixels (with their offset) through the perturbed camera to angles, then the study's
/// method with the perturbed constants. Knots are the nominal fit's; trajectory methods start from its parameters and keep its roughness,
/// the filter its noise as well.
class StudyChain {
 public:
  /// Makes the nominal fit. RunError with its words if it gives no result.
  StudyChain(Session& session, const std::string& method);
  ~StudyChain();
  StudyChain(const StudyChain&) = delete;
  StudyChain& operator=(const StudyChain&) = delete;

  [[nodiscard]] const Rig& rig() const { return *rig_; }
  [[nodiscard]] const Fit& nominal() const { return nominal_; }
  [[nodiscard]] const QuantitiesOfInterest& numbers() const { return *numbers_; }
  /// One run; thread-safe. What cannot be computed is a failure with its reason, not an exception.
  [[nodiscard]] ChainResult run(const std::vector<double>& errors) const;

 private:
  struct Recording;
  void make_nominal(Session& session, const std::string& method);
  void read_recordings(Session& session);
  [[nodiscard]] Model perturbed(const PerturbedRig& rig) const;
  [[nodiscard]] std::vector<Signals> signals(const PerturbedRig& rig, const Model& model) const;
  [[nodiscard]] Fit fit(const Model& model, const std::vector<Signals>& experiments) const;

  Prepared prepared_;
  FittedMethod from_;    ///< where every run starts
  bool pixels_ = false;  ///< the system predicts the image: angles are not needed
  std::vector<Recording> recordings_;
  Fit nominal_;
  std::optional<Rig> rig_;
  std::optional<QuantitiesOfInterest> numbers_;
};

/// The first of the study's methods (or of those asked for) that gives a result, with its chain.
[[nodiscard]] std::unique_ptr<StudyChain> chain_of(Session& session);

}  // namespace misfit
