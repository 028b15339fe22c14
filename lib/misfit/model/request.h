#pragma once

#include <optional>
#include <span>

#include "misfit/data/geometry.h"
#include "misfit/data/study.h"
#include "misfit/model/model.h"

namespace misfit {

/// A study read against the systems and effects that the program knows: what to assemble, and the rig for the camera.
struct StudyModel {
  ModelRequest request;
  RigGeometry rig;  ///< entries that the study does not give are 0; require_rig() says which are missing
};

/// A length or speed of the rig by its name in [geometry].
struct RigEntry {
  const char* name;
  double RigGeometry::*field;
};
[[nodiscard]] std::span<const RigEntry> rig_entries();

/// Names, units and bounds of [system], [geometry], [effects], [parameters] and [curves] against the registry. Knots without a unit
/// are taken in the one that is shown (display_unit()). What an effect's line says of a parameter counts where [parameters] does not say
/// it. InputError with file, line and nearest name.
[[nodiscard]] StudyModel read_model(const Study& study, const Registry& registry);

/// How [parameters] of the study calls a parameter of the model, of parameter_names(); its name in the model where nothing is said of it.
[[nodiscard]] std::string name_in_study(const Study& study, const std::map<std::string, std::string>& names, const std::string& parameter);
/// The same of [curves].
[[nodiscard]] std::string curve_in_study(const Study& study, const std::map<std::string, std::string>& names, const std::string& curve);

/// The same request in the system's regression form (SystemSpec::regression): for sliding_bin. Curves keep their places under the names of
/// that form; effects with free coefficients other than the static and damping curves are left out, and named in `left_out`. nullopt if the
/// system has none.
[[nodiscard]] std::optional<ModelRequest> regression_form(const ModelRequest& request, const Registry& registry,
                                                          std::vector<std::string>& left_out);

/// Checks that the rig holds what a camera needs: R, R_cp, V, l_b, l_s, and for a sweep l_p, R1, R2, R3. InputError naming what is missing.
void require_rig(const Study& study, const RigGeometry& rig, bool for_sweep);

}  // namespace misfit
