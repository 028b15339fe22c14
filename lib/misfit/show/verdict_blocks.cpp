#include <fmt/format.h>
#include <fmt/ranges.h>

#include "misfit/show/error_changes.h"
#include "misfit/show/verdict.h"

namespace misfit {

namespace {

/// By change_in_words(): nothing is said twice.
bool is_said_in(const std::string& sentence, const ErrorChange& e) {
  return e.after && sentence.find(e.what() + " ") != std::string::npos && sentence.find("from " + shown(e)) != std::string::npos;
}

}  // namespace

Blocks blocks_of(const Verdict& v) {
  Blocks out;
  out.heading("Verdict");
  out.paragraph(v.sentence, Tone::lead);
  out.paragraph(fmt::format("{}", fmt::join(v.notes, " ")));
  out.paragraph(v.where);
  std::vector<std::string> errors = v.added;
  if (!v.parameters.empty()) errors.push_back("parameters of the fitted model: " + v.parameters);
  for (const std::string& doubt : v.doubts) errors.push_back("doubtful: " + doubt);
  for (const ErrorChange& e : v.errors) {
    if (!is_said_in(v.sentence, e)) errors.push_back(e.what() + ": " + shown(e));
  }
  if (v.trim) errors.push_back(v.trim->what() + ": " + shown(*v.trim));
  out.list({errors});
  if (!v.next.empty()) out.paragraph("next: " + v.next, Tone::command);
  return out;
}

}  // namespace misfit
