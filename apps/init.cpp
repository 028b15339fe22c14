#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/verbs.h"
#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/text.h"
#include "misfit/core/written_files.h"
#include "misfit/report/recording_figure.h"
#include "misfit/workflow/init/names.h"
#include "misfit/workflow/init/text.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

const char* word_of(ColumnUse use) {
  constexpr const char* words[] = {"time", "input", "output", "rate", "segment", "constant", "text", "unused"};
  return words[static_cast<std::size_t>(use)];
}

/// Where the study goes: --out, else a folder called like the data in the present one.
fs::path folder_for(const Options& options, const fs::path& data) {
  return options.out.empty() ? fs::path(part_names(data, 1).front()) : fs::path(options.out);
}

std::string survey_text(const RecordingSurvey& survey) {
  std::string out = fmt::format("{}: {}, {} rows\n", survey.source, survey.format, survey.rows);
  out += fmt::format("  one sample each {:g} s ({:.6g} Hz){}\n\n", survey.step, 1.0 / survey.step,
                     survey.jitter > 1e-3 * survey.step ? fmt::format(", uneven by {:.2g} s", survey.jitter) : "");
  std::vector<std::vector<std::string>> rows = {{"column", "read as", "unit", "from", "to", "steps of", "missing", "because"}};
  for (const auto& c : survey.columns) {
    const bool numbers = c.use != ColumnUse::text;
    rows.push_back({c.header, std::string(word_of(c.use)) + (c.use == ColumnUse::input || c.use == ColumnUse::output ? " " + c.name : ""),
                    c.unit, numbers ? format_value(c.low) : "", numbers ? format_value(c.high) : "",
                    c.resolution > 0.0 ? format_value(c.resolution) : "", c.missing > 0 ? std::to_string(c.missing) : "", c.why});
  }
  out += align_columns(rows) + "\n";
  for (const auto& remark : survey.remarks) out += wrap_text("note: " + remark, 110, "  ") + "\n";
  return out;
}

nlohmann::ordered_json as_json(const RecordingSurvey& survey) {
  nlohmann::ordered_json json = {{"source", survey.source}, {"format", survey.format}, {"rows", survey.rows},
                                 {"step", survey.step},     {"jitter", survey.jitter}, {"parts", survey.parts.size()}};
  json["columns"] = nlohmann::ordered_json::array();
  for (const auto& c : survey.columns) {
    json["columns"].push_back({{"header", c.header},
                               {"name", c.name},
                               {"unit", c.unit},
                               {"use", word_of(c.use)},
                               {"why", c.why},
                               {"missing", c.missing},
                               {"from", c.low},
                               {"to", c.high},
                               {"resolution", c.resolution},
                               {"rate_of", c.rate_of}});
  }
  json["gaps"] = nlohmann::ordered_json::array();
  for (const auto& gap : survey.gaps) json["gaps"].push_back({gap.from, gap.to});
  json["remarks"] = survey.remarks;
  return json;
}

/// About ten swings where the model swings, else some hundred samples [s].
double length_of_zoom(const GuessedModel& model, double step) {
  constexpr double swings = 10.0, samples = 800.0;
  for (const auto& output : model.outputs) {
    if (output.guess.order == 2) return swings * 2.0 * std::numbers::pi / std::sqrt(output.guess.stiffness);
  }
  return samples * step;
}

void draw(const RecordingSurvey& survey, const GuessedModel& model, const std::vector<std::string>& names, const fs::path& folder) {
  const double zoom = length_of_zoom(model, survey.step);
  for (std::size_t i = 0; i < survey.parts.size(); ++i) {
    const Table& part = survey.parts[i];
    const std::vector<double>& t = part.columns.front().values;
    write_figure(folder / "figures", report::recording_figure(survey, i, names[i], std::nullopt));
    constexpr double long_record = 2.5;
    if (t.back() - t.front() < long_record * zoom) continue;
    write_figure(folder / "figures",
                 report::recording_figure(survey, i, names[i], report::typical_interval(t, part.columns.back().values, zoom)));
  }
}

}  // namespace

int init_verb(const Options& options, const Registry& /*registry*/) {
  const fs::path data = options.study;
  RecordingSurvey survey = survey_recording(data, names_of_formulas());
  const GuessedModel model = guess_model(survey);
  survey.remarks.insert(survey.remarks.end(), model.remarks.begin(), model.remarks.end());
  const fs::path folder = folder_for(options, data);
  const std::vector<std::string> names = part_names(data, survey.parts.size());
  write_files(folder, {{data}, options.force}, {"study.toml", "model.toml", names.front() + ".csv"}, [&](const fs::path& dir) {
    for (std::size_t i = 0; i < names.size(); ++i) write_csv(dir / (names[i] + ".csv"), survey.parts[i]);
    write_atomically(dir / "model.toml", model_text(model, survey));
    write_atomically(dir / "study.toml", study_text(study_name(data), names, survey));
    draw(survey, model, names, dir);
  });
  if (options.json) {
    std::cout << as_json(survey).dump(1) << '\n';
    return 0;
  }
  std::cout << survey_text(survey) << '\n';
  for (const auto& o : model.outputs) std::cout << wrap_text("model of " + o.name + ": " + o.guess.why, 110, "  ") << '\n';
  const std::string study = (folder / "study.toml").lexically_normal().string();
  std::cout << fmt::format("\nwritten: {}, model.toml, the data as {}.csv{}, figures/\nnext: look at the figures, then misfit fit {}\n",
                           study, names.front(), names.size() > 1 ? " …" : "", study);
  return 0;
}

}  // namespace misfit
