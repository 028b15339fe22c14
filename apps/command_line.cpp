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
#include <map>
#include <new>
#include <string_view>
#include <thread>
#include <tuple>

#include "apps/help.h"
#include "apps/progress.h"
#include "apps/terminal.h"
#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/version.h"
#include "misfit/data/estimators.h"
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

void add_method(CLI::App& verb, Options& options) {
  verb.add_option("--method", options.session.methods, "only these methods")->type_name("NAME")->check(CLI::IsMember(estimator_names()));
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
  verb.add_option("data", options.session.study, "CSV file with a header line")->type_name("DATA.csv")->required();
  verb.add_flag("--force", options.session.force, "overwrite an existing study (never the data)");
  verb.add_option("--out", options.session.out, "folder of the study (default: named after the data file, in the current directory)")
      ->type_name("DIR");
  verb.add_flag("--json", options.json, "print what was found as JSON");
}

void export_options(CLI::App& verb, Options& options) {
  add_study(verb, options);
  ExportRequest& request = options.export_request;
  verb.add_option("--to", request.format, "json, csv, c, python or jsbsim")->type_name("FORMAT")->required();
  verb.add_option("--out", request.out, "the file (of csv: the folder) to write (default: in export/ of the run folder)")
      ->type_name("PATH");
  verb.add_option("--method", request.method, "the estimate by this method (default: the last of the study that has one)")
      ->type_name("NAME");
  verb.add_option("--rung", request.rung, "number or effect of a rung of the ladder; 0 is the study's own model (default: the last)")
      ->type_name("RUNG");
  verb.add_option("--run", options.session.out, "run folder (default: out/ beside the study)")->type_name("DIR");
  add_force(verb, options);
  verb.add_flag("--quiet", options.quiet, "print no notes to stderr");
}

void effects_options(CLI::App& verb, Options& options) {
  verb.add_option("what", options.session.study, "key of an effect, or a study: study.toml, or the folder that holds it")
      ->type_name("KEY|STUDY");
  verb.add_option("effect", options.effect, "effect of that study")->type_name("KEY");
  verb.add_flag("--json", options.json, "print the effects as JSON");
}

struct VerbEntry {
  const char* name;
  const char* doc;
  Verb call;
  void (*add_options)(CLI::App&, Options&);
};

constexpr VerbEntry verbs[] = {
    {"run", "run all stages of the study and write the report; stages whose inputs have not changed are skipped", run_verb, run_options},
    {"track", "follow the marker through the video: track.csv, contact sheet, lost samples and their reasons", track_verb, track_options},
    {"calibrate", "estimate camera height, scale and the further parameters that the static sweep supports", calibrate_verb, study_options},
    {"attitude", "compute the angles of the axis from the track", attitude_verb, study_options},
    {"fit", "estimate the model's curves and parameters", fit_verb, fit_options},
    {"diagnose", "residual diagnostics: unexplained force against states, inputs and time; whiteness tests", diagnose_verb, fit_options},
    {"discover", "rank the effects the model may be missing; continues from the last model of the ladder", discover_verb, discover_options},
    {"add", "add an effect (or system:KIND) to the last rung: writes and fits a new study, prints the error before and after", add_verb,
     add_verb_options},
    {"compare", "compare methods with each other and with reference curves, simulated with measured motion", compare_verb, fit_options},
    {"uncertainty", "propagate geometry, camera and mass uncertainty to the results (Monte Carlo, on threads or under mpirun)",
     uncertainty_verb, uncertainty_options},
    {"report", "write the figures and one self-contained page", report_verb, fit_options},
    {"simulate", "simulate the model as described in [simulate], or as fitted", simulate_verb, study_options},
    {"batch", "fit many studies as one job, on threads or under mpirun; tabulate how their results vary", batch_verb, batch_options},
    {"export", "write the estimate for other programs: curves and parameters with covariance, as a model in C or Python, for JSBSim",
     export_verb, export_options},
    {"init", "write a first study for a CSV file: column roles, linear model, figures", init_verb, init_options},
    {"effects", "list the effects of the program, or of a study; with the key of an effect, print it in full", effects_verb,
     effects_options},
};

std::string command_text(int argc, char** argv) {
  std::string out = "misfit";
  for (int i = 1; i < argc; ++i) out += std::string(" ") + argv[i];
  return out;
}

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const auto& verb : verbs) names.emplace_back(verb.name);
  return names;
}

/// What `misfit help` alone prints: the verbs, and the topics beside them.
std::string contents_of_help() {
  constexpr std::size_t columns = 100;
  std::string out;
  const auto add = [&](const std::string& name, const std::string& doc) {
    out += "  " + name + wrap_text(doc, columns, std::string(14, ' ')).substr(2 + name.size()) + "\n";
  };
  out += "misfit help VERB (the same as misfit VERB --help)\n";
  for (const auto& verb : verbs) add(verb.name, verb.doc);
  out += "\nmisfit help TOPIC\n";
  for (const auto& [topic, doc] : help_topics()) add(topic, doc);
  return out;
}

/// `misfit help …`; nullopt for a verb, whose own help is to be printed.
std::optional<std::string> help_on(int argc, char** argv, const Registry& registry) {
  if (argc < 3) return contents_of_help();
  if (argc > 3) throw InputError("misfit help takes one verb or topic");
  const std::string topic = argv[2];
  std::vector<std::string> names = verb_names();
  for (const auto& [name, doc] : help_topics()) names.push_back(name);
  if (std::find(names.begin(), names.end(), topic) == names.end())
    throw InputError("misfit help knows no '" + shown(topic) + "'" + suggest(topic, names));
  for (const auto& [name, doc] : help_topics()) {
    if (name == topic) return help_text(topic, registry);
  }
  return std::nullopt;
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

int dispatch(int argc, char** argv, const Registry& registry, PrintableStream& out);

int print_help(int argc, char** argv, const Registry& registry, PrintableStream& out) {
  if (const auto text = help_on(argc, argv, registry)) {
    std::cout << *text;
    return 0;
  }
  std::string own_help = "--help";
  std::array<char*, 3> of_verb = {argv[0], argv[2], own_help.data()};
  return dispatch(3, of_verb.data(), registry, out);
}

int dispatch(int argc, char** argv, const Registry& registry, PrintableStream& out) {
  if (argc > 1 && std::string_view(argv[1]) == "help") return print_help(argc, argv, registry, out);
  CLI::App app{"misfit — find out what your model is missing"};
  app.set_version_flag("--version", std::string("misfit ") + version() + " (" + commit() + ")");
  app.require_subcommand(1);
  Options options;
  options.session.command = command_text(argc, argv);
  std::map<const CLI::App*, Verb> calls;
  for (const auto& entry : verbs) {
    CLI::App* verb = app.add_subcommand(entry.name, entry.doc);
    entry.add_options(*verb, options);
    calls[verb] = entry.call;
  }
  if (argc > 1 && argv[1][0] != '-') refuse_unknown_verb(argv[1]);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw InputError(shortened(error.what(), longest_message / 2) + "; see misfit --help and misfit VERB --help");
  }
  const CLI::App* chosen = app.get_subcommands().front();
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  refuse_ranks(chosen->get_name());
  if (!options.quiet && (ranks_started() == 1 || ranks().first())) options.session.listener = terminal_listener();
  if (options.json) out.use_json_escapes();
  return calls.at(chosen)(options, registry);
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
