#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "apps/verb_texts.h"
#include "apps/verbs.h"

namespace misfit {

/// What the parser knows of a verb's options, as plain data.
[[nodiscard]] VerbManual manual_of(const VerbText& text);

/// Reads the words behind a verb; false: its help is asked for. InputError: words that it does not take, with the nearest option's name.
[[nodiscard]] bool read_options(const std::string& verb, const std::vector<std::string>& words, Options& options);

/// Its exit status. `verb` is one of verb_texts(), here as above.
int call_verb(std::string_view verb, const Options& options, const Registry& registry);

}  // namespace misfit
