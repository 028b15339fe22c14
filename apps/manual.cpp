// Help, manual pages and completion, all made of what the parser of the command line knows and of apps/verb_texts.cpp.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "apps/help.h"
#include "apps/verb_texts.h"
#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/core/version.h"

namespace misfit {
namespace {

constexpr std::size_t line_width = 100;

/// "  name      text", further lines below the text; a name that is too long has a line of its own.
std::string manual_entry(const std::string& name, const std::string& text, std::size_t column) {
  const std::string lines = wrap_text(text, line_width, std::string(column, ' '));
  if (name.size() + 4 > column) return "  " + name + "\n" + lines + "\n";
  return "  " + name + lines.substr(2 + name.size()) + "\n";
}

std::string with_type(const OptionText& option) { return option.type.empty() ? option.name : option.name + " " + option.type; }

/// "misfit add STUDY EFFECT [OPTIONS]".
std::string usage(const VerbManual& verb) {
  std::string out = std::string("misfit ") + verb.text.name;
  for (const OptionText& option : verb.options) {
    if (option.argument) out += option.required ? " " + option.name : " [" + option.name + "]";
    if (!option.argument && option.required) out += " " + with_type(option);
  }
  return out + " [OPTIONS]";
}

std::string doc_of(const OptionText& option) {
  if (option.choices.empty()) return option.doc;
  return fmt::format("{}: {}", option.doc, fmt::join(option.choices, ", "));
}

// Manual pages.

/// Text as troff takes it: a backslash, a minus sign and what begins a request are escaped.
std::string troff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out.empty() || (out.front() != '.' && out.front() != '\'') ? out : "\\&" + out;
}

std::string head(const std::string& name, const std::string& doc) {
  return fmt::format(".TH \"{}\" 1 \"\" \"misfit {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", troff(name), version(), troff(name),
                     troff(doc));
}
std::string section(const std::string& title, const std::string& text) { return fmt::format(".SH {}\n{}\n", title, troff(text)); }
std::string item(const std::string& name, const std::string& doc) { return fmt::format(".TP\n\\fB{}\\fR\n{}\n", troff(name), troff(doc)); }

constexpr const char* exit_status =
    "0: done, also where one of several methods declined and said why. 1: the data, the model or the disk do not allow it, or it was "
    "interrupted. "
    "2: bad command line or study.";

// Completion.

std::string words_of(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::string completion_of(const VerbManual& verb) {
  std::vector<std::string> names{"--help"};
  std::string values;
  for (const OptionText& option : verb.options) {
    if (option.argument) continue;
    names.push_back(option.name);
    if (!option.choices.empty()) values += fmt::format("        {}) words=\"{}\" ;;\n", option.name, words_of(option.choices));
    if (option.choices.empty() && !option.type.empty()) values += fmt::format("        {}) files=yes ;;\n", option.name);
  }
  return fmt::format("    {})\n      options=\"{}\"\n      case $previous in\n{}      esac ;;\n", verb.text.name, words_of(names), values);
}

}  // namespace

std::string verb_help(const VerbManual& verb) {
  constexpr std::size_t column = 11;
  std::string out = wrap_text(fmt::format("misfit {}: {}", verb.text.name, verb.text.doc), line_width) + "\n\n  " + usage(verb) + "\n\n";
  out += manual_entry("reads", verb.text.reads, column) + manual_entry("writes", verb.text.writes, column) +
         manual_entry("example", verb.text.example, column) + "\n";
  for (const OptionText& option : verb.options) out += manual_entry(with_type(option), doc_of(option), 26);
  return out + manual_entry("-h, --help", "this text", 26);
}

std::string contents_of_help(std::span<const VerbText> verbs) {
  constexpr std::size_t column = 14;
  std::string out =
      "misfit: find out what your model is missing\n\nmisfit VERB … runs a verb; misfit help VERB, or misfit VERB --help, describes it\n";
  for (const VerbText& verb : verbs) out += manual_entry(verb.name, verb.doc, column);
  out += "\nmisfit help TOPIC\n";
  for (const auto& [topic, doc] : help_topics()) out += manual_entry(topic, doc, column);
  return out + "\nmisfit alone says what to do next in this folder; misfit --version prints the version.\n";
}

std::string manual_page(const VerbManual& verb) {
  std::string out = head(std::string("misfit-") + verb.text.name, verb.text.doc) + section("SYNOPSIS", usage(verb));
  out += section("READS", verb.text.reads) + section("WRITES", verb.text.writes) + ".SH OPTIONS\n";
  for (const OptionText& option : verb.options) out += item(with_type(option), doc_of(option));
  out += item("-h, --help", "print this help");
  return out + section("EXAMPLE", verb.text.example) + section("EXIT STATUS", exit_status) + ".SH SEE ALSO\n.BR misfit (1)\n";
}

std::string manual_page(const std::vector<VerbManual>& verbs) {
  std::string out = head("misfit", "find out what your model is missing") + section("SYNOPSIS", "misfit VERB STUDY [OPTIONS]");
  out +=
      section("DESCRIPTION",
              "Grey-box system identification: fits a model made of named physical effects to recordings, shows where it fails, ranks the "
              "effects that it may be missing, adds them. A study is a folder with study.toml and data; results lie in out/ beside it. "
              "Without a verb misfit says what to do next in this folder.");
  out += ".SH VERBS\n";
  for (const VerbManual& verb : verbs) out += item(verb.text.name, verb.text.doc);
  out += ".SH HELP\n";
  for (const auto& [topic, doc] : help_topics()) out += item("misfit help " + topic, doc);
  out += section("EXIT STATUS", exit_status) + ".SH SEE ALSO\n";
  for (std::size_t i = 0; i < verbs.size(); ++i)
    out += fmt::format(".BR misfit\\-{} (1){}\n", verbs[i].text.name, i + 1 < verbs.size() ? "," : "");
  return out;
}

std::string bash_completion(const std::vector<VerbManual>& verbs) {
  std::vector<std::string> names, topics;
  std::string cases;
  for (const VerbManual& verb : verbs) {
    names.emplace_back(verb.text.name);
    cases += completion_of(verb);
  }
  for (const auto& [topic, doc] : help_topics()) topics.push_back(topic);
  return fmt::format(R"(# bash completion for misfit
_misfit() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} options="" words="" files=""
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "{0} help --help --version" -- "$current"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
    help) COMPREPLY=($(compgen -W "{0} {1}" -- "$current")); return ;;
{2}  esac
  if [[ -n $words ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  elif [[ $current == -* && -z $files ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  fi
}}
complete -o default -F _misfit misfit
)",
                     words_of(names), words_of(topics), cases);
}

void write_manual(const std::string& folder, const std::vector<VerbManual>& verbs) {
  const std::filesystem::path root = folder;
  make_writable_folder(root / "man1");
  make_writable_folder(root / "bash-completion");
  write_atomically(root / "man1/misfit.1", manual_page(verbs));
  for (const VerbManual& verb : verbs) write_atomically(root / "man1" / fmt::format("misfit-{}.1", verb.text.name), manual_page(verb));
  write_atomically(root / "bash-completion/misfit", bash_completion(verbs));
}

}  // namespace misfit
