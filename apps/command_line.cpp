#include "apps/command_line.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <iostream>
#include <limits>
#include <new>
#include <string_view>
#include <thread>
#include <tuple>

#include "apps/help.h"
#include "apps/progress.h"
#include "apps/terminal.h"
#include "apps/verb_texts.h"
#include "apps/verbs.h"
#include "apps/what_next.h"
#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/version.h"
#include "misfit/data/estimators.h"
#include "misfit/data/log/log.h"
#include "misfit/jobs/interrupt.h"
#include "misfit/jobs/ranks.h"

namespace misfit {
namespace {

/// The first Ctrl-C (or SIGTERM) asks all work to stop, and is answered at once; the second ends the program where it is.
extern "C" void on_interrupt(int) {
  constexpr std::string_view answer = "\nmisfit: stopping; once more ends it at once\n";
  if (!interrupted().exchange(true)) std::ignore = ::write(STDERR_FILENO, answer.data(), answer.size());
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

using Verb = int (*)(const Options&, const Registry&);

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

void add_verbose(CLI::App& verb, Options& options) {
  verb.add_flag("--verbose", options.verbose, "print the tables of every stage instead of a line");
}

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

void add_work(CLI::App& verb, Options& options) {
  verb.add_option("--out", options.session.out, "run folder (default: out/ beside the study)")->type_name("DIR");
  add_force(verb, options);
  add_method(verb, options);
  add_running(verb, options);
}

// The options of each verb.
void study_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  add_work(verb, options);
}

void fit_options(CLI::App& verb, Options& options) {
  study_options(verb, options);
  add_time_limit(verb, options);
}

void run_options(CLI::App& verb, Options& options) {
  fit_options(verb, options);
  add_round_limit(verb, options);
  add_verbose(verb, options);
  verb.add_flag("--auto", options.automatic, "also add what discover accepts and search again, until nothing is accepted");
}

void track_options(CLI::App& verb, Options& options) {
  study_options(verb, options);
  verb.add_option("--check-video", options.check_video, "also write the video with the track drawn on it (.avi, .mp4 or .mkv)")
      ->type_name("FILE");
}

void discover_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  verb.add_flag("--auto", options.automatic, "add the accepted effect and search again, until none is accepted");
  add_work(verb, options);
  add_time_limit(verb, options);
  add_round_limit(verb, options);
  add_verbose(verb, options);
}

void add_verb_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  verb.add_option("effect", options.effect, "key of the effect, or system:KIND")->type_name("EFFECT")->required();
  add_work(verb, options);
  add_time_limit(verb, options);
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
  verb.add_flag("--json", options.json, "print the effects as JSON");
}

struct VerbEntry {
  std::string_view name;
  Verb call;
  void (*add_options)(CLI::App&, Options&);
};

/// In any order: verb_texts() has the one in which they are listed.
constexpr VerbEntry verbs[] = {{"run", run_verb, run_options},
                               {"track", track_verb, track_options},
                               {"calibrate", calibrate_verb, study_options},
                               {"attitude", attitude_verb, study_options},
                               {"fit", fit_verb, fit_options},
                               {"diagnose", diagnose_verb, fit_options},
                               {"discover", discover_verb, discover_options},
                               {"add", add_verb, add_verb_options},
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

std::string command_text(int argc, char** argv) {
  std::string out = "misfit";
  for (int i = 1; i < argc; ++i) out += std::string(" ") + argv[i];
  return out;
}

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const VerbText& verb : verb_texts()) names.emplace_back(verb.name);
  return names;
}

/// What the parser knows of a verb's options, as plain data.
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
    if (one.name == "--method") one.choices = estimator_names();
    if (one.name == "--to") one.choices = export_formats();
    out.options.push_back(std::move(one));
  }
  return out;
}
std::vector<VerbManual> all_manuals() {
  std::vector<VerbManual> out;
  for (const VerbText& text : verb_texts()) out.push_back(manual_of(text));
  return out;
}
const VerbText& text_of(const std::string& name) {
  const auto texts = verb_texts();
  return *std::find_if(texts.begin(), texts.end(), [&](const VerbText& text) { return name == text.name; });
}

/// `misfit help …`.
std::string help_on(const std::vector<std::string>& words, const Registry& registry) {
  if (words.empty()) return contents_of_help(verb_texts());
  if (words.size() > 1) throw InputError("misfit help takes one verb or topic");
  const std::string& topic = words.front();
  std::vector<std::string> names = verb_names();
  if (std::find(names.begin(), names.end(), topic) != names.end()) return verb_help(manual_of(text_of(topic)));
  for (const auto& [name, doc] : help_topics()) {
    if (name == topic) return help_text(topic, registry);
    names.push_back(name);
  }
  throw InputError("misfit help knows no '" + shown(topic) + "'" + suggest(topic, names));
}

/// Answers without a verb: `misfit` alone, help, the version.
std::optional<std::string> answer_without_verb(const std::vector<std::string>& words, const Registry& registry) {
  if (words.empty()) return what_next(".", installed_examples());
  const std::string& first = words.front();
  if (first == "--version") return std::string("misfit ") + version() + " (" + commit() + ")\n";
  if (first == "--help" || first == "-h") return help_on({}, registry);
  if (first != "help") return std::nullopt;
  if (words.size() == 3 && words[1] == "--manual") {  // for the build: not in any help
    write_manual(words[2], all_manuals());
    return "";
  }
  return help_on({words.begin() + 1, words.end()}, registry);
}

/// Verbs that are one job would do it several times over, in one folder.
void refuse_ranks(const std::string& verb) {
  if (ranks_started() > 1 && verb != "uncertainty" && verb != "batch" && verb != "discover")
    throw InputError("'" + verb + "' cannot run under mpirun; only uncertainty, batch and discover can");
}

void refuse_unknown_verb(const std::string& verb) {
  std::vector<std::string> names = verb_names();
  names.emplace_back("help");
  if (std::find(names.begin(), names.end(), verb) == names.end())
    throw InputError("unknown verb '" + shown(verb) + "'" + suggest(verb, names));
}

/// Why the parser did not take the words behind a verb; an option that the verb does not have is named before all else.
[[noreturn]] void refuse_words(const VerbManual& verb, const std::vector<std::string>& words, const CLI::ParseError& error) {
  const std::string name = verb.text.name;
  std::vector<std::string> names{"--help"};
  for (const OptionText& option : verb.options) {
    if (!option.argument) names.push_back(option.name);
  }
  for (const std::string& word : words) {
    const std::string option = word.substr(0, word.find('='));
    if (option.starts_with("--") && option.size() > 2 && std::find(names.begin(), names.end(), option) == names.end())
      throw InputError(name + " has no option '" + shown(option) + "'" + suggest(option, names));
  }
  throw InputError(name + ": " + shortened(error.what(), longest_message / 2) + "; see misfit help " + name);
}

/// A table is no study: what makes one of it.
void refuse_table(const std::string& verb, const std::string& study) {
  if (verb != "init" && !study.ends_with(".toml") && is_recording_name(study))
    throw InputError(shown(study) + " is a recording, not a study; misfit init " + shown(study) + " makes a study of it");
}

int dispatch(int argc, char** argv, const Registry& registry, PrintableStream& out) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (const auto answer = answer_without_verb(words, registry)) {
    std::cout << *answer;
    return 0;
  }
  const std::string& name = words.front();
  refuse_unknown_verb(name);
  CLI::App verb("", name);
  Options options;
  options.session.command = command_text(argc, argv);
  entry_of(name).add_options(verb, options);
  std::vector<std::string> rest(words.rbegin(), words.rend() - 1);  // the last word first, as CLI11 wants them
  try {
    verb.parse(rest);
  } catch (const CLI::CallForHelp&) {
    std::cout << verb_help(manual_of(text_of(name)));
    return 0;
  } catch (const CLI::ParseError& error) {
    refuse_words(manual_of(text_of(name)), {words.begin() + 1, words.end()}, error);
  }
  refuse_table(name, options.session.study);
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  refuse_ranks(name);
  if (!options.quiet && (ranks_started() == 1 || ranks().first())) options.session.listener = terminal_listener();
  if (options.json) out.use_json_escapes();
  return entry_of(name).call(options, registry);
}

/// An error in the study occurs on every rank: the first reports it and ends them all. A rank still alive after three seconds has an
/// error of its own, and reports it.
void silence_other_ranks() {
  try {
    if (ranks_started() > 1 && !ranks().first()) std::this_thread::sleep_for(std::chrono::seconds(3));
  } catch (const std::exception&) {  // without MPI each reports its own
    return;
  }
}

void say_error(const std::string& message) { std::cerr << shortened("misfit: " + message) << '\n'; }

int status_of(int argc, char** argv, const Registry& registry, PrintableStream& out) {
  try {
    return dispatch(argc, argv, registry, out);
  } catch (const EndedElsewhere&) {
    return 1;  // the rank where it failed says why
  } catch (const InputError& error) {
    silence_other_ranks();
    say_error(error.what());
    return 2;
  } catch (const std::bad_alloc&) {
    say_error("out of memory while running '" + shown(command_text(argc, argv), 2 * longest_quote) +
              "': smaller data, fewer threads (--threads 1) or more memory is needed");
    return 1;
  } catch (const std::exception& error) {
    say_error(error.what());
    return 1;
  }
}

/// Results in files are whole; what was to be printed is not.
int with_output_checked(int status, PrintableStream& out) {
  const std::string failure = out.failure();
  if (failure.empty()) return status;
  say_error("standard output could not be written: " + failure + "; results in files are not affected");
  return std::max(status, 1);
}

}  // namespace

int run_command_line(int argc, char** argv, const Registry& registry) {
  reserve_standard_streams();
  PrintableStream out(std::cout);
  if (terminal_style().colour) out.allow_colours();
  const PrintableStream errors(std::cerr);
  const int status = with_output_checked(status_of(argc, argv, registry, out), out);
  try {
    end_ranks(status);
  } catch (const std::exception& error) {
    if (status == 0) say_error(error.what());
    return std::max(status, 1);
  }
  return status;
}

}  // namespace misfit
