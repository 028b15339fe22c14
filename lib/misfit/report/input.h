#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
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
#include "misfit/data/track.h"
#include "misfit/data/track_facts.h"
#include "misfit/data/uncertainty.h"
#include "misfit/data/verdict.h"

namespace misfit::report {

/// One experiment as measured; either part may be absent.
struct ExperimentInput {
  std::string name;
  std::optional<Track> track;
  std::optional<TrackFacts> video;  ///< how the track came out of a video
  std::string contact_sheet;        ///< PNG, as bytes; empty without video
  std::optional<Attitude> attitude;
};

/// How this run came about.
struct RunFacts {
  std::string version, commit, command;
  unsigned long seed = 0;
  std::map<std::string, std::string> hashes;           ///< file, as the study names it → hash
  std::vector<std::pair<std::string, double>> stages;  ///< stage → seconds
  std::string date = {};                               ///< "2026-11-22"
};

/// What was found of the model of a rung.
struct RungInput {
  int id = 0;
  std::string added;
  std::optional<Diagnosis> diagnosis;
  std::optional<Discovery> discovery;
};

/// The model of the ladder's last rung, by its own fits.
struct LastModel {
  int id = 0;
  std::string added;
  std::vector<Fit> fits;
  Comparison comparison;
};

/// All that a report shows. The report computes nothing: what is not here is not in it.
struct ReportInput {
  std::string study, question;
  std::optional<Verdict> verdict;
  std::vector<Fit> fits;
  std::vector<ExperimentInput> experiments;
  std::optional<Calibration> calibration;
  std::optional<Comparison> comparison;
  std::optional<Ladder> ladder;
  std::optional<Diagnosis> diagnosis;  ///< of the study's own model, as the next
  std::optional<Discovery> discovery;
  std::optional<LastModel> last_model;  ///< missing: nothing was added
  std::optional<RungInput> rung;        ///< the same of a rung of the ladder: the last that was looked at
  std::optional<Uncertainty> uncertainty;
  std::optional<Resampling> resampling;
  std::vector<Reference> references;
  /// Markup behind the document, of at most so many bytes: the same results as a page of scripts. Empty: none.
  std::function<std::string(std::size_t room)> explorer = {};
  std::vector<std::string> notes;  ///< further findings or limits, in sentences
  RunFacts run;
};

}  // namespace misfit::report
