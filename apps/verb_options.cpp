#include "apps/verb_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/data/estimators.h"

namespace misfit {
namespace {

/// One of these words, else the nearest is named.
CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto check = [words](const std::string& text) -> std::string {
    return std::find(words.begin(), words.end(), text) != words.end() ? "" : "there is no '" + shown(text) + "'" + suggest(text, words);
  };
  return {check, ""};
}

void add_method(CLI::App& verb, Options& options) {
  verb.add_option("--method", options.session.methods, "only these methods")->type_name("NAME")->check(one_of(estimator_names()));
}

/// CLI11 takes what does not fit for the largest number that does. As in a study, where TOML sets the limit.
CLI::Validator whole_number_check() {
  constexpr long most = std::numeric_limits<long>::max();
  const auto check = [](const std::string& text) -> std::string {
    long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = error == std::errc() && end == text.data() + text.size() && value >= 0;
    return good ? "" : "'" + shown(text) + "': a whole number from 0 to " + std::to_string(most) + " is expected";
  };
  return {check, ""};
}

void add_running(CLI::App& verb, Options& options) {
  verb.add_option("--threads", options.session.threads, "threads for parallel jobs (default: one per core)")
      ->type_name("N")
      ->check(CLI::Range(0, 1024));
  verb.add_option("--seed", options.session.seed, "overrides the study's seed")->type_name("N")->check(whole_number_check());
  verb.add_flag("--quiet", options.quiet, "print no progress and no notes to stderr");
  verb.add_flag("--json", options.json, "print the result as JSON");
}

void add_study(CLI::App& verb, Options& options) {
  verb.add_option("study", options.session.study, "study.toml, or the folder that holds it")->type_name("STUDY")->required();
}

void add_verbose(CLI::App& verb, Options& options, const std::string& doc) { verb.add_flag("--verbose", options.verbose, doc); }

void add_force(CLI::App& verb, Options& options) {
  verb.add_flag("--force", options.session.force, "overwrite files that misfit did not write (never data, never through links)");
}

/// Of a time limit: a positive number of seconds.
CLI::Validator seconds_check() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = error == std::errc() && end == text.data() + text.size() && std::isfinite(value) && value > 0.0;
    return good ? "" : "'" + shown(text) + "': a number of seconds above 0 is expected";
  };
  return {check, ""};
}

void add_time_limit(CLI::App& verb, Options& options) {
  verb.add_option("--time-limit", options.session.time_limit,
                  "of every fit and refit: then it ends with its best values, unconverged (default: [fit] time_limit of the study)")
      ->type_name("SECONDS")
      ->check(seconds_check());
}

void add_round_limit(CLI::App& verb, Options& options) {
  verb.add_option("--round-limit", options.session.round_limit,
                  "of a round of discover: then it ends with what was found (default: [discover] time_limit of the study)")
      ->type_name("SECONDS")
      ->check(seconds_check());
}

/// Of a verb that works in a run folder, whatever the methods.
void add_work_alone(CLI::App& verb, Options& options) {
  verb.add_option("--out", options.session.out, "run folder (default: out/ beside the study)")->type_name("DIR");
  add_force(verb, options);
  add_running(verb, options);
}

void add_work(CLI::App& verb, Options& options) {
  add_work_alone(verb, options);
  add_method(verb, options);
}

constexpr const char* until_nothing_is_gained =
    "add the accepted effect, or where none is accepted the one that explains most or a curve of unknown form, and search again, until "
    "nothing more is gained or 12 rounds are done; rungs that later ones make needless are taken off";

// The options of each verb.
void study_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  add_work(verb, options);
}

/// Of a stage before all fits.
void measure_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  add_work_alone(verb, options);
}

void fit_options(CLI::App& verb, Options& options) {
  study_options(verb, options);
  add_time_limit(verb, options);
}

void run_options(CLI::App& verb, Options& options) {
  fit_options(verb, options);
  add_round_limit(verb, options);
  add_verbose(verb, options, "print the tables of every stage instead of a line");
  verb.get_option("--json")->description("print compare.json (the verdict is in verdict.json of the run folder)");
  verb.add_flag("--auto", options.automatic, until_nothing_is_gained);
}

void track_options(CLI::App& verb, Options& options) {
  measure_options(verb, options);
  verb.add_option("--check-video", options.check_video, "also write the video with the track drawn on it (.avi, .mp4 or .mkv)")
      ->type_name("FILE");
}

void discover_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  verb.add_flag("--auto", options.automatic, until_nothing_is_gained);
  add_work(verb, options);
  add_time_limit(verb, options);
  add_round_limit(verb, options);
  add_verbose(verb, options, "with --auto: print the tables of every round instead of a line");
}

void added_effect_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  verb.add_option("effect", options.effect, "key of the effect, or system:KIND")->type_name("EFFECT")->required();
  verb.add_option("--at", options.at,
                  "where it acts, as discover lists it: a role and what it is bound to, once for each role; or default (default: the place "
                  "that explains most)")
      ->type_name("ROLE=NAME")
      ->allow_extra_args(false);
  add_work(verb, options);
  add_time_limit(verb, options);
}

void remove_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  verb.add_option("rung", options.rung, "number or effect of the rung; those above it go with it")->type_name("RUNG")->required();
  add_work(verb, options);
}

void set_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  verb.add_option("settings", options.settings,
                  "keys of the study and their values; an experiment goes by its name: experiment.NAME.validation")
      ->type_name("KEY=VALUE…")
      ->required();
}

void uncertainty_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  verb.add_option("--runs", options.session.runs, "overrides the study's number of runs")
      ->type_name("N")
      ->check(CLI::Range(1, 100'000'000));
  add_work(verb, options);
  add_time_limit(verb, options);
}

void batch_options(CLI::App& verb, Options& options) {
  verb.add_option("studies", options.studies, "lists with one study per line, folders to search for study.toml, studies")
      ->type_name("LIST|FOLDER…")
      ->required();
  verb.add_option("--out", options.session.out, "folder of the results (default: batch/ beside the list or in the folder)")
      ->type_name("DIR");
  add_force(verb, options);
  add_method(verb, options);
  add_running(verb, options);
  add_time_limit(verb, options);
}

void init_options(CLI::App& verb, Options& options) {
  verb.add_option("data", options.session.study, "recording: CSV, MAT, HDF5, NPY, NPZ, ULog or DataFlash .bin (misfit help data)")
      ->type_name("DATA")
      ->required();
  RecordingChoice& choice = options.recording;
  verb.add_option("--output", choice.outputs, "outputs, by names; others that are no inputs are left out")
      ->type_name("NAME,...")
      ->delimiter(',');
  verb.add_option("--input", choice.inputs, "inputs, by names (default: by name and by the data)")->type_name("NAME,...")->delimiter(',');
  verb.add_option("--time", choice.time, "the column or channel of time")->type_name("NAME");
  verb.add_option("--topic", choice.topics, "topics, groups or structs of a log; the first gives the times")
      ->type_name("TOPIC,...")
      ->delimiter(',');
  verb.add_option("--names", choice.names, "headers of a CSV file without any, as t[s],u[V],w[rad/s]")
      ->type_name("NAME,...")
      ->delimiter(',');
  verb.add_flag("--force", options.session.force, "overwrite an existing study (never the data)");
  verb.add_option("--out", options.session.out, "folder of the study (default: named after the data file, in the current directory)")
      ->type_name("DIR");
  verb.add_flag("--json", options.json, "print what was found as JSON");
}

void export_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  ExportRequest& request = options.export_request;
  verb.add_option("--to", request.format, "format")->type_name("FORMAT")->required()->check(one_of(export_formats()));
  verb.add_option("--out", request.out,
                  "the file (of csv: the folder) to write, - for standard output (default: in export/ of the run folder)")
      ->type_name("PATH");
  verb.add_option("--method", request.method, "the estimate by this method (default: the last of the study that has one)")
      ->type_name("NAME")
      ->check(one_of(estimator_names()));
  verb.add_option("--rung", request.rung, "number or effect of a rung of the ladder; 0 is the study's own model (default: the last)")
      ->type_name("RUNG");
  verb.add_option("--run", options.session.out, "run folder (default: out/ beside the study)")->type_name("DIR");
  add_force(verb, options);
  verb.add_flag("--quiet", options.quiet, "print no notes to stderr");
}

void open_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  verb.add_option("--out", options.session.out, "run folder (default: out/ beside the study)")->type_name("DIR");
  verb.add_option("--port", options.port, "port of 127.0.0.1 (default: a free one)")->type_name("N")->check(CLI::Range(0, 65535));
}

void effects_options(CLI::App& verb, Options& options) {
  verb.add_option("what", options.session.study, "key of an effect, or a study: study.toml, or the folder that holds it")
      ->type_name("KEY|STUDY");
  verb.add_option("effect", options.effect, "effect of that study")->type_name("KEY");
  add_verbose(verb, options, "print all that is known of each effect instead of its formula");
  verb.add_flag("--json", options.json, "print the effects as JSON");
}

/// A verb of the command line: what it calls, and the options that it takes.
struct VerbEntry {
  std::string_view name;
  int (*call)(const Options&, const Registry&);
  void (*add_options)(CLI::App&, Options&);
};

/// In any order: verb_texts() has the one in which they are listed.
constexpr VerbEntry verbs[] = {{"run", run_verb, run_options},
                               {"track", track_verb, track_options},
                               {"calibrate", calibrate_verb, measure_options},
                               {"attitude", attitude_verb, measure_options},
                               {"fit", fit_verb, fit_options},
                               {"diagnose", diagnose_verb, fit_options},
                               {"discover", discover_verb, discover_options},
                               {"add", add_verb, added_effect_options},
                               {"remove", remove_verb, remove_options},
                               {"set", set_verb, set_options},
                               {"compare", compare_verb, fit_options},
                               {"uncertainty", uncertainty_verb, uncertainty_options},
                               {"report", report_verb, fit_options},
                               {"simulate", simulate_verb, study_options},
                               {"batch", batch_verb, batch_options},
                               {"export", export_verb, export_options},
                               {"init", init_verb, init_options},
                               {"open", open_verb, open_options},
                               {"effects", effects_verb, effects_options}};

const VerbEntry& entry_of(std::string_view name) {
  return *std::find_if(std::begin(verbs), std::end(verbs), [&](const VerbEntry& entry) { return entry.name == name; });
}

/// The words that an option takes; empty: any.
std::vector<std::string> choices_of(const std::string& option) {
  if (option == "--method") return estimator_names();
  if (option == "--to") return export_formats();
  return {};
}

/// Why the parser did not take the words behind a verb; an option that the verb does not have is named before all else.
[[noreturn]] void refuse_words(const CLI::App& verb, const std::vector<std::string>& words, const CLI::ParseError& error) {
  const std::string& name = verb.get_name();
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    if (!option->get_positional()) names.push_back(option->get_name());
  }
  for (const std::string& word : words) {
    const std::string option = word.substr(0, word.find('='));
    if (option.starts_with("--") && option.size() > 2 && std::find(names.begin(), names.end(), option) == names.end())
      throw InputError(name + " has no option '" + shown(option) + "'" + suggest(option, names));
  }
  std::string valid;
  for (const CLI::Option* option : verb.get_options()) {
    const bool missing = option->get_required() && option->count() == 0;
    const std::vector<std::string> choices = missing ? choices_of(option->get_name()) : std::vector<std::string>{};
    if (!choices.empty()) valid = fmt::format("; {} takes {}", option->get_name(), fmt::join(choices, ", "));
  }
  throw InputError(name + ": " + shortened(error.what(), longest_message / 2) + valid + "; see misfit help " + name);
}

}  // namespace

VerbManual manual_of(const VerbText& text) {
  CLI::App verb;
  Options options;
  entry_of(text.name).add_options(verb, options);
  VerbManual out{text, {}};
  for (const CLI::Option* option : verb.get_options([](const CLI::Option* o) { return o->get_name() != "--help"; })) {
    const bool argument = option->get_positional();
    const bool is_switch = option->get_items_expected_max() == 0;
    OptionText one{argument ? option->get_type_name() : option->get_name(), is_switch || argument ? "" : option->get_type_name(),
                   option->get_description(), argument, option->get_required()};
    one.choices = choices_of(one.name);
    out.options.push_back(std::move(one));
  }
  return out;
}

bool read_options(const std::string& verb, const std::vector<std::string>& words, Options& options) {
  CLI::App parser("", verb);
  entry_of(verb).add_options(parser, options);
  std::vector<std::string> last_first(words.rbegin(), words.rend());  // as CLI11 wants them
  try {
    parser.parse(last_first);
  } catch (const CLI::CallForHelp&) {
    return false;
  } catch (const CLI::ParseError& error) {
    refuse_words(parser, words, error);
  }
  return true;
}

int call_verb(std::string_view verb, const Options& options, const Registry& registry) { return entry_of(verb).call(options, registry); }

}  // namespace misfit
