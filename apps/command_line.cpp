#include "apps/command_line.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>
#include <string_view>
#include <thread>
#include <tuple>

#include "apps/help.h"
#include "apps/progress.h"
#include "apps/terminal.h"
#include "apps/verb_options.h"
#include "apps/verb_texts.h"
#include "apps/verbs.h"
#include "apps/what_next.h"
#include "misfit/core/error.h"
#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/core/version.h"
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
  for (const auto& [name, doc] : help_topics()) {
    if (name == topic) return help_text(topic, registry);
  }
  if (std::find(names.begin(), names.end(), topic) != names.end()) return verb_help(manual_of(text_of(topic)));
  const std::vector<std::string> effects = registry.effect_keys();
  if (std::find(effects.begin(), effects.end(), topic) != effects.end())
    return topic + " is an effect; misfit effects " + topic + " prints it in full\n";
  for (const auto& [name, doc] : help_topics()) names.push_back(name);
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

/// A table is no study: what makes one of it.
void refuse_table(const std::string& verb, const std::string& study) {
  if (verb == "init" || study.ends_with(".toml") || !is_recording_name(study)) return;
  std::error_code error;
  if (!std::filesystem::exists(study, error)) throw InputError({study, 0, 0}, "no such file");
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
  Options options;
  options.session.command = command_text(argc, argv);
  if (!read_options(name, {words.begin() + 1, words.end()}, options)) {
    std::cout << verb_help(manual_of(text_of(name)));
    return 0;
  }
  refuse_table(name, options.session.study);
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  refuse_ranks(name);
  if (!options.quiet && (ranks_started() == 1 || ranks().first())) options.session.listener = terminal_listener();
  if (options.json) out.use_json_escapes();
  return call_verb(name, options, registry);
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
