#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "misfit/calibrate/calibrate.h"
#include "misfit/data/calibration.h"
#include "misfit/data/sweep.h"
#include "misfit/data/uncertainty.h"
#include "misfit/uncertainty/perturbation.h"
#include "misfit/workflow/session/session.h"

namespace misfit {

/// The rig, camera and constants of a study with errors in them.
struct PerturbedRig {
  RigGeometry geometry;
  std::optional<Calibration> calibration;
  double offset_y = 0.0, offset_z = 0.0;    ///< added to every P_y, P_z [px]
  std::map<std::string, double> constants;  ///< of the model: name → value, SI
};

/// What [uncertainty] perturb of a study means: which lengths, camera parameters, image offsets and constants of the model it names, in
/// which units.
class Rig {
 public:
  /// `model`: the one the method works with. InputError with the place in the study: a name that nothing depends on (with the nearest), one
  /// that is estimated, a wrong unit, one given twice.
  Rig(Session& session, const Model& model);

  [[nodiscard]] const Perturbations& perturbations() const { return perturbations_; }
  [[nodiscard]] std::vector<PerturbedParameter> described() const { return described_; }
  /// `errors`: order of perturbations().names(). Calibrates again where the study says so. Thread-safe.
  [[nodiscard]] PerturbedRig at(const std::vector<double>& errors) const;
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// A name and its nominal value; the name alone determines where it acts.
  struct Known {
    std::string unit;
    double value = 0.0;
  };
  void list_known(Session& session, const Model& model);
  void add(const PerturbStudy& request, const Model& model);
  void add_calibration(const Session& session, const Model& model);
  void note_fixed_camera(const Model& model);
  void calibrate_again(const std::vector<std::string>& names, const std::vector<double>& errors, PerturbedRig& rig) const;
  void set(PerturbedRig& rig, const std::string& name, double error) const;

  PerturbedRig nominal_;
  std::map<std::string, Known> known_;
  Perturbations perturbations_;
  std::vector<PerturbedParameter> described_;
  std::optional<Sweep> sweep_;  ///< where the camera is calibrated again
  CalibrateOptions calibrate_;
  std::vector<std::string> notes_;
};

/// Camera parameters that the study perturbs, where its system would estimate them with the calibration as their prior: they are fixed, so
/// that they can be perturbed. Called before the model is prepared.
void fix_perturbed_camera(Session& session);

}  // namespace misfit
