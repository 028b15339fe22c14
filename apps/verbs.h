#pragma once

#include <string>
#include <vector>

#include "misfit/recording/choice.h"
#include "misfit/workflow/export.h"
#include "misfit/workflow/ladder.h"

namespace misfit {

/// What the command line asks for.
struct Options {
  SessionOptions session;
  bool quiet = false, json = false;
  bool verbose = false;               ///< tables of every stage instead of a line
  std::vector<std::string> studies;   ///< batch: lists, folders, studies
  std::string effect;                 ///< add
  std::vector<std::string> at;        ///< add: its place
  std::string rung;                   ///< remove
  std::vector<std::string> settings;  ///< set: KEY=VALUE
  bool automatic = false;             ///< discover --auto, run --auto
  std::string check_video;            ///< track: write the video with the track drawn to this file
  ExportRequest export_request;       ///< export
  RecordingChoice recording;          ///< init
  int port = 0;                       ///< open; 0: a free one
};

// One function per verb: open the study, call the stages, print. Each in apps/NAME.cpp. Return the exit status.
int track_verb(const Options& options, const Registry& registry);
int calibrate_verb(const Options& options, const Registry& registry);
int attitude_verb(const Options& options, const Registry& registry);
int simulate_verb(const Options& options, const Registry& registry);
int fit_verb(const Options& options, const Registry& registry);
int compare_verb(const Options& options, const Registry& registry);
int report_verb(const Options& options, const Registry& registry);
int diagnose_verb(const Options& options, const Registry& registry);
int discover_verb(const Options& options, const Registry& registry);
int uncertainty_verb(const Options& options, const Registry& registry);
int batch_verb(const Options& options, const Registry& registry);
int add_verb(const Options& options, const Registry& registry);
int remove_verb(const Options& options, const Registry& registry);
int set_verb(const Options& options, const Registry& registry);
int run_verb(const Options& options, const Registry& registry);
int export_verb(const Options& options, const Registry& registry);
int init_verb(const Options& options, const Registry& registry);
int open_verb(const Options& options, const Registry& registry);
int effects_verb(const Options& options, const Registry& registry);

/// Tells what happens while a ladder is extended: a line each, with --verbose the tables, with --json nothing.
[[nodiscard]] LadderListener ladder_listener(ModelLadder& ladder, const Options& options);

}  // namespace misfit
