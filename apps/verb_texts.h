#pragma once

#include <span>
#include <string>
#include <vector>

namespace misfit {

/// What is said of a verb: in --help, in the manual pages, for completion.
struct VerbText {
  const char* name;
  const char* doc;      ///< what it does, in one line
  const char* reads;    ///< files it reads
  const char* writes;   ///< files it writes, in the run folder where nothing else is said
  const char* example;  ///< a command
};
[[nodiscard]] std::span<const VerbText> verb_texts();

/// An option or an argument of a verb, as the parser of the command line knows it.
struct OptionText {
  std::string name;  ///< "--out", or "STUDY" of an argument
  std::string type;  ///< "DIR"; empty: a switch
  std::string doc;
  bool argument = false, required = false;
  std::vector<std::string> choices = {};  ///< values, where they are few
};
struct VerbManual {
  VerbText text;
  std::vector<OptionText> options;
};

/// misfit VERB --help, in lines of at most 100 characters.
[[nodiscard]] std::string verb_help(const VerbManual& verb);
/// misfit help, and misfit --help.
[[nodiscard]] std::string contents_of_help(std::span<const VerbText> verbs);

/// A manual page in the macros of man(7): of a verb, and of the program.
[[nodiscard]] std::string manual_page(const VerbManual& verb);
[[nodiscard]] std::string manual_page(const std::vector<VerbManual>& verbs);
/// Completion of verbs, options, their values, and files, for bash.
[[nodiscard]] std::string bash_completion(const std::vector<VerbManual>& verbs);
/// Writes them all: FOLDER/man1/misfit.1, misfit-VERB.1, FOLDER/bash-completion/misfit.
void write_manual(const std::string& folder, const std::vector<VerbManual>& verbs);

}  // namespace misfit
