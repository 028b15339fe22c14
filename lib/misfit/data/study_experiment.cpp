// [[experiment]] of a study.

#include <algorithm>
#include <regex>

#include "misfit/core/shown.h"
#include "misfit/core/text.h"
#include "misfit/data/log/log.h"
#include "misfit/data/study_parts.h"

namespace misfit::study_parts {
namespace {

using config::DescribedSection;
using config::Section;

constexpr const char* validation_forms = "\"last 25 %\", [t0, t1] in seconds, or a file (.csv, .mat, .ulg, …) is expected";

void read_source(const DescribedSection& section, const Study& study, ExperimentStudy& experiment) {
  experiment.track = existing_file(section, "track", study.folder);
  experiment.video = existing_file(section, "video", study.folder);
  experiment.data = existing_file(section, "data", study.folder);
  const int given = (experiment.track ? 1 : 0) + (experiment.video ? 1 : 0) + (experiment.data ? 1 : 0);
  if (given == 0) section.refuse_unknown();
  if (given != 1) section.fail("", "exactly one of track, video and data is needed, " + std::to_string(given) + " are given");
}

void read_columns(const Section& section, const Study& study, ExperimentStudy& experiment) {
  const auto columns = section.table("columns");
  if (!columns) return;
  for (const std::string& name : columns->keys()) {
    const bool known = !experiment.track || std::count(track_signals().begin(), track_signals().end(), name) > 0;
    if (!known) columns->fail(name, "a track has no such signal" + suggest(name, track_signals()));
    const std::string channel = columns->text(name).value_or("");
    const std::vector<std::string> in_film = film_channels(study.video.marker_names());
    if (experiment.video && std::count(in_film.begin(), in_film.end(), channel) == 0)
      columns->fail(name, "the video gives no '" + shown(channel) + "', but " + join_words(in_film) + suggest(channel, in_film));
  }
  for (const std::string& name : columns->keys()) experiment.columns.header_of.emplace_back(name, *columns->text(name));
  columns->finish();
  experiment.columns_section = columns;
}

void read_interval(const Section& section, ExperimentStudy& experiment) {
  const auto ends = section.numbers("validation", "s");
  if (ends->size() != 2 || (*ends)[0] >= (*ends)[1]) section.fail("validation", "[t0, t1] needs two times, the first before the second");
  experiment.validation = ExperimentStudy::Validation::interval;
  experiment.from = (*ends)[0];
  experiment.to = (*ends)[1];
}

/// A recording of its own: read like the experiment's, all of it held out.
ExperimentStudy wholly_held_out(const Section& section, const Study& study, const ExperimentStudy& experiment) {
  ExperimentStudy other = experiment;
  const std::filesystem::path file = *existing_file(section, "validation", study.folder);
  (experiment.data ? other.data : other.track) = file;
  other.video.reset();
  constexpr double whole = 1e12;  // [s] of either sign: more than any recording lasts
  other.validation = ExperimentStudy::Validation::interval;
  other.from = -whole;
  other.to = whole;
  other.name = experiment.name + " validation";
  return other;
}

void read_validation(const Section& section, ExperimentStudy& experiment) {
  if (section.is_array("validation")) return read_interval(section, experiment);
  if (section.has("validation") && !section.is_text("validation")) section.fail_value("validation", validation_forms);
  const auto given = section.text("validation");
  if (!given) return;
  const std::string& text = *given;
  std::smatch match;
  constexpr std::size_t longest = 60;  // characters: matching takes stack for each
  if (text.size() <= longest && std::regex_match(text, match, std::regex(R"(\s*last\s+(\d{1,3}(\.\d{1,9})?)\s*%\s*)"))) {
    experiment.validation = ExperimentStudy::Validation::last_fraction;
    experiment.fraction = std::stod(match[1]) / 100.0;
    if (experiment.fraction <= 0.0 || experiment.fraction >= 1.0)
      section.fail("validation", "the part held out must be above 0 % and below 100 %");
  } else if (!is_recording_name(text)) {
    section.fail("validation", "'" + shown(text) + "': " + validation_forms);
  }
}

void refuse_twice(const Section& section, const Study& study, const std::string& name) {
  for (const ExperimentStudy& earlier : study.experiments) {
    if (earlier.name != name) continue;
    section.fail("name", "two experiments are called '" + shown(name) + "' (the other on line " + std::to_string(earlier.where.line) +
                             "): give each a name of its own");
  }
}

/// A name becomes part of file names.
void read_name(const Section& section, const Study& study, ExperimentStudy& experiment) {
  const auto& file = experiment.track ? experiment.track : experiment.video ? experiment.video : experiment.data;
  experiment.name = section.text("name").value_or(file->stem().string());
  constexpr std::size_t longest = 150;  // bytes: what stands before and after it must fit too
  const std::string& name = experiment.name;
  const bool fits = !name.empty() && name.size() <= longest && name.front() != '.' && name.find_first_of("/\\\n\t") == std::string::npos;
  if (!fits || printable(name) != name)
    section.fail("name", "'" + shown(name) + "': a name without /, \\ and control characters, of at most " + std::to_string(longest) +
                             " bytes, that does not begin with a dot is expected");
  refuse_twice(section, study, experiment.name);
}

bool names_a_file(const Section& section) {
  return section.has("validation") && section.is_text("validation") && is_recording_name(*section.text("validation"));
}

}  // namespace

void read_experiments(const Section& root, Study& study) {
  for (const Section& table : root.tables("experiment")) {
    const DescribedSection section(table, config::group_of(study_keys(), "experiment"));
    ExperimentStudy experiment;
    experiment.where = section.where();
    read_source(section, study, experiment);
    read_columns(section, study, experiment);
    read_validation(section, experiment);
    experiment.exclude = *section.integer("exclude");
    read_name(section, study, experiment);
    std::optional<ExperimentStudy> other;
    if (names_a_file(section)) other = wholly_held_out(section, study, experiment);
    section.finish();
    study.experiments.push_back(std::move(experiment));
    if (!other) continue;
    refuse_twice(section, study, other->name);
    study.experiments.push_back(std::move(*other));
  }
}

}  // namespace misfit::study_parts
