#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "misfit/data/fit.h"
#include "misfit/data/signals.h"
#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/workflow/measure/measure.h"

namespace misfit {

// From a study and its data to fits.

/// The model with knots chosen, and the recordings as it sees them.
struct Prepared {
  ModelRequest request;
  Model model;
  std::vector<Signals> experiments;
};
/// Does the system predict the image itself? Then it reads the track; every other system reads the attitude.
[[nodiscard]] bool predicts_pixels(const SystemSpec& spec);
/// A system that predicts the image sees it through the study's camera: values and sigmas of the calibration, and its projection.
void add_camera(Session& session, ModelRequest& request);
/// The same with a calibration that is there already.
void add_camera(const Calibration& calibration, const Registry& registry, ModelRequest& request);
/// For the study's own system.
[[nodiscard]] Prepared prepare(Session& session);
/// Curves for which [curves] of the study gives a table, as values of the assembled model.
void set_curves_from_tables(const Session& session, const ModelRequest& request, Model& model);
/// For the regression form of sliding_bin; nullopt where the system has none. Names of effects it leaves out go to `left_out`.
[[nodiscard]] std::optional<Prepared> prepare_regression(Session& session, std::vector<std::string>& left_out);
/// Does the attitude stage already average over three samples the channel that the regression reads?
[[nodiscard]] bool averaged_by_attitude(const Session& session);

/// filter_error with everything that diagnosis and discovery need of it. `estimate` points into `prepared`: kept behind one pointer, never
/// copied.
struct FilterWork {
  Prepared prepared;
  Fit fit;
  std::optional<FilterEstimate> estimate;  ///< absent: declined, the fit says why
};

/// fit/METHOD/… for every method asked for, in order, and resolved.toml.
[[nodiscard]] std::vector<Fit> fit_stage(Session& session);
/// The same for these methods.
[[nodiscard]] std::vector<Fit> fit_stage(Session& session, const std::vector<std::string>& names);
/// filter_error's estimate: the one of this run of the program, else estimated again (about two seconds, and the same answer). RunError
/// with the fit's words if it declined.
[[nodiscard]] std::shared_ptr<const FilterWork> filter_work(Session& session);
/// What a fit by `method` depends on: not comments and spaces of the study, nor the tables and keys in `without` (config::content_of). The
/// usual limit of the session only where it has cut the fit off: then a fit with more time is another one.
[[nodiscard]] StageInputs inputs_of_fit(const Session& session, const std::string& method, const std::vector<std::string>& without = {});
/// Everything the fits left on disk.
[[nodiscard]] std::vector<std::filesystem::path> files_of_fits(const Session& session, const std::vector<Fit>& fits);

/// Runs filter_error where it must; did it decline or fail?
[[nodiscard]] bool filter_declined(Session& session);
/// All files that its fit left: another estimate is another diagnosis. None if there is no fit.
[[nodiscard]] std::vector<std::filesystem::path> files_of_filter(const Session& session);
/// RunError with the words of the declined fit: for verbs that cannot go on without it.
[[noreturn]] void refuse_declined(Session& session);

/// DIR/resolved.toml: the study with every default and every choice made from the data spelled out, as it is to lie in the run folder.
void write_resolved(const Session& session, const Prepared& prepared, const std::filesystem::path& dir);

}  // namespace misfit
