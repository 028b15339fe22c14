#pragma once

#include <string>
#include <vector>

#include "misfit/data/reference.h"
#include "misfit/data/verdict.h"
#include "misfit/page/places.h"

namespace misfit::page {

/// A study whose page is put into its report.
struct EmbeddedPage {
  std::string study, question;
  const Verdict* verdict = nullptr;  ///< nullptr: there is none
  std::vector<Place> places;         ///< its own, then the rungs
  std::vector<Reference> references;
  std::vector<std::string> warnings;  ///< above all: what of the results is left out, and why
};

/// The answers that the server would give, as JSON: {"lists": [[…], …], "answers": {"where?model=0": …}}. Long lists of numbers, which many
/// answers share, stand once: in an answer {"$": k} stands for the list k. They are put in while all stay below `most` bytes, those of the
/// last model, which the page shows first, before those of earlier ones, and those of the first view of a model before its others. Where
/// they are too many, recordings are thinned (thinned.h), and the page says so. Empty if not even the motion and the missing
/// force of the last model find room.
[[nodiscard]] std::string embedded_answers(const EmbeddedPage& page, std::size_t most);

/// The page of `misfit open` without a server, as markup of at most `most` bytes for the end of the body of report.html: template, style
/// sheet, compressed embedded_answers(), and script. Where scripts are off, and in print, none of it is seen. Of a view that found no room
/// the page says that `misfit open` shows it. Empty where embedded_answers() is.
[[nodiscard]] std::string embedded_page(const EmbeddedPage& page, std::size_t most);

}  // namespace misfit::page
