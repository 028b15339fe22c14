#pragma once

#include <optional>
#include <vector>

#include "misfit/data/attitude.h"
#include "misfit/data/calibration.h"
#include "misfit/data/candidates.h"
#include "misfit/data/comparison.h"
#include "misfit/data/diagnosis.h"
#include "misfit/data/fit.h"
#include "misfit/data/intervals.h"
#include "misfit/data/ladder.h"
#include "misfit/data/reference.h"
#include "misfit/data/signals.h"
#include "misfit/data/track_facts.h"
#include "misfit/data/uncertainty.h"
#include "misfit/fit/filter/filter_estimate.h"
#include "misfit/fit/regression/equation_error.h"
#include "misfit/jobs/work_queue.h"
#include "misfit/workflow/session.h"

namespace misfit {

// Each stage reads what it needs from the session and the run folder, skips its work when nothing it depends on has changed since
// (run.json), and leaves its result on disk. They are run in this order; each calls the ones it needs.

/// Is there a track of the experiment, given or made from its video?
[[nodiscard]] bool has_track(const ExperimentStudy& experiment);
/// Where it is: the study's own file, or what the track stage writes to the run folder (then with facts and contact sheet).
struct TrackFiles {
  std::filesystem::path track, facts, sheet;
};
[[nodiscard]] TrackFiles track_files(const Session& session, std::size_t experiment);
/// track.csv, track.json and figures/contact_sheet.png of every experiment that starts from a video (track_NAME… for further ones); nullopt
/// for others.
[[nodiscard]] std::vector<std::optional<TrackFacts>> track_stage(Session& session);
/// The first video of the study with its track drawn on it, to the file `to`. `facts`: what track_stage() gave. WriteError: write_rules().
void write_check_video(const Session& session, const std::vector<std::optional<TrackFacts>>& facts, const std::filesystem::path& to);
/// Files that are never written over.
[[nodiscard]] WriteRules write_rules(const Session& session);
/// The table of the sweep: the study's own, or sweep.csv made from its pictures (with figures/sweep_sheet.png).
[[nodiscard]] std::filesystem::path sweep_stage(Session& session);
/// camera.json; nullopt if the study has no camera.
[[nodiscard]] std::optional<Calibration> calibrate_stage(Session& session);
/// attitude.csv (attitude_NAME.csv for further experiments); empty for experiments without a track.
std::vector<std::optional<Attitude>> attitude_stage(Session& session);
/// attitude.csv or, of further experiments, attitude_NAME.csv.
[[nodiscard]] std::filesystem::path attitude_file(const Session& session, std::size_t experiment);
/// camera.json, and of every experiment that starts from pixels the track and the attitude.
[[nodiscard]] std::vector<std::filesystem::path> files_of_attitude(const Session& session);

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
/// For the study's own system.
[[nodiscard]] Prepared prepare(Session& session);
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
/// What a fit by `method` depends on: not comments and spaces of the study, nor the tables and keys in `without` (config::content_of).
[[nodiscard]] StageInputs inputs_of_fit(const Session& session, const std::string& method, const std::vector<std::string>& without = {});
/// Everything the fits left on disk.
[[nodiscard]] std::vector<std::filesystem::path> files_of_fits(const Session& session, const std::vector<Fit>& fits);
[[nodiscard]] std::vector<Reference> references(const Session& session);
/// Statistics of motions that the fitted model of filter_error makes, against the measured one (lib/misfit/README.md, 6.1).
[[nodiscard]] SimulatedMotion simulated_motion(const FilterWork& work, unsigned long seed, int threads, const ProgressFn& progress);
/// compare.json.
[[nodiscard]] Comparison compare_stage(Session& session, const std::vector<Fit>& fits);
/// figures/ and report.html; returns the page.
std::filesystem::path report_stage(Session& session, const std::vector<Fit>& fits);

/// uncertainty.json, uncertainty.csv and their figures: the Monte-Carlo of [uncertainty]. On ranks other than the first the result is
/// empty. InputError if the study has no such section.
[[nodiscard]] Uncertainty uncertainty_stage(Session& session);
/// What a stored job of `what` depends on but its number, `more` left out too: not what the study is called, nor which methods it asks
/// for.
[[nodiscard]] StageInputs inputs_of_jobs(const Session& session, const std::string& what, std::vector<std::string> more);
/// One word for all these.
[[nodiscard]] std::string digest_of(const StageInputs& inputs);
/// What it left on disk, where it still belongs to the study and its data.
[[nodiscard]] std::optional<Uncertainty> known_uncertainty(const Session& session);

/// Whether [uncertainty] has `bootstrap` or `profile`.
[[nodiscard]] bool asks_for_resampling(const Study& study);
/// InputError at its line if a name in `profile` is none of which a profile can be taken: to be called before anything is computed.
void check_profile_names(Session& session);
/// bootstrap.json, bootstrap.csv, profile.json, resampling.json and their figures: block bootstrap and profiles of every method asked for
/// that can be fitted again. A method that declines or fails is a note. On ranks other than the first the result is empty. RunError: none
/// could be resampled.
[[nodiscard]] Resampling resampling_stage(Session& session);
/// What it left on disk, where it still belongs to the study and its data.
[[nodiscard]] std::optional<Resampling> known_resampling(const Session& session);

/// diagnosis.json and missing_force.csv; nullopt if filter_error declined (its fit says why). Runs that fit where it must.
[[nodiscard]] std::optional<Diagnosis> diagnose_stage(Session& session);
/// candidates.json and discovery.json; nullopt if filter_error declined.
[[nodiscard]] std::optional<Discovery> discover_stage(Session& session);
/// The same; RunError in the fit's words if filter_error declined.
[[nodiscard]] Discovery discovered(Session& session);
/// What discovery says of one effect: from the whole search where that is on disk, else it alone is screened. nullopt if it cannot be
/// screened (it has no strength, or is driven by noise, or stands for another).
[[nodiscard]] std::optional<Candidate> predict_effect(Session& session, const std::string& effect);
/// What these stages left on disk, where it still belongs to the fit that is there.
[[nodiscard]] std::optional<Diagnosis> known_diagnosis(const Session& session);
[[nodiscard]] std::optional<Discovery> known_discovery(const Session& session);
/// Both, and the files they are in; what is on disk but of another fit is said in `notes`.
struct Findings {
  std::optional<Diagnosis> diagnosis;
  std::optional<Discovery> discovery;
  std::vector<std::filesystem::path> files;
};
[[nodiscard]] Findings findings_of(const Session& session, std::vector<std::string>& notes);
/// Of the last rung that has any.
struct RungFindings {
  int rung = 0;
  std::string added;
  Findings findings;
};
[[nodiscard]] std::optional<RungFindings> findings_of_last_rung(const Session& session, const Ladder& ladder,
                                                                std::vector<std::string>& notes);
[[nodiscard]] StageInputs inputs_of_discovery(const Session& session);
/// ladder.json where it still belongs to the study and its data (workflow/ladder.h).
[[nodiscard]] std::optional<Ladder> known_ladder(const Session& session);
/// Runs filter_error where it must; did it decline or fail?
[[nodiscard]] bool filter_declined(Session& session);
/// All files that its fit left: another estimate is another diagnosis. None if there is no fit.
[[nodiscard]] std::vector<std::filesystem::path> files_of_filter(const Session& session);
/// RunError with the words of the declined fit: for verbs that cannot go on without it.
[[noreturn]] void refuse_declined(Session& session);

/// DIR/resolved.toml: the study with every default and every choice made from the data spelled out, as it is to lie in the run folder.
void write_resolved(const Session& session, const Prepared& prepared, const std::filesystem::path& dir);

}  // namespace misfit
