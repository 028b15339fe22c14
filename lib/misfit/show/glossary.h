#pragma once

#include <string>
#include <utility>
#include <vector>

namespace misfit {

/// Glossary that misfit uses in a sense of its own, each with its meaning.
using Glossary = std::vector<std::pair<const char*, std::string>>;

/// Those of lib/misfit/README.md, 2, that a user meets first: misfit help words, and the end of a report.
[[nodiscard]] Glossary main_glossary();
[[nodiscard]] Glossary further_glossary();

}  // namespace misfit
