#pragma once

#include <string>

namespace misfit {

/// A word of a shell: in quotation marks where it has characters other than letters, digits and ./-_:
[[nodiscard]] std::string shell_word(const std::string& text);

/// "misfit VERB STUDY --out FOLDER", as a shell takes it; `words` stand behind the study, as they are; an empty `out`: the usual run
/// folder.
[[nodiscard]] std::string misfit_command(const std::string& verb, const std::string& study, const std::string& words,
                                         const std::string& out);

}  // namespace misfit
