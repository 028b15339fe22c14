#include "misfit/workflow/init/init.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "misfit/core/files.h"
#include "misfit/core/written_files.h"
#include "misfit/report/recording_figure.h"
#include "misfit/workflow/init/drivers.h"
#include "misfit/workflow/init/names.h"
#include "misfit/workflow/init/text.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

/// About ten periods where the model oscillates, else several hundred samples [s].
double length_of_zoom(const GuessedModel& model, double step) {
  constexpr double periods = 10.0, samples = 800.0;
  for (const auto& output : model.outputs) {
    if (output.guess.order == 2) return periods * 2.0 * std::numbers::pi / std::sqrt(output.guess.stiffness);
  }
  return samples * step;
}

void draw(const RecordingSurvey& survey, const GuessedModel& model, const std::vector<std::string>& names, const fs::path& folder) {
  const double zoom = length_of_zoom(model, survey.step);
  std::vector<report::Figure> figures;
  for (std::size_t i = 0; i < survey.parts.size(); ++i) {
    const Table& part = survey.parts[i];
    const std::vector<double>& t = part.columns.front().values;
    figures.push_back(report::recording_figure(survey, i, names[i], std::nullopt));
    constexpr double long_record = 2.5;
    if (t.back() - t.front() < long_record * zoom) continue;
    figures.push_back(report::recording_figure(survey, i, names[i], report::typical_interval(t, part.columns.back().values, zoom)));
  }
  static_cast<void>(report::write_figures(folder / "figures", figures));
}

}  // namespace

FirstStudy init_study(const fs::path& data, const RecordingChoice& choice, const fs::path& folder, bool force) {
  FirstStudy out;
  out.survey = survey_recording(data, names_of_formulas(), choice);
  if (choice.inputs.empty()) take_measured_inputs(out.survey);
  out.model = guess_model(out.survey);
  out.survey.remarks.insert(out.survey.remarks.end(), out.model.remarks.begin(), out.model.remarks.end());
  out.parts = part_names(data, out.survey.parts.size());
  const fs::path to = folder.empty() ? fs::path(part_names(data, 1).front()) : folder;
  write_files(to, {{data}, force}, {"study.toml", "model.toml", out.parts.front() + ".csv"}, [&](const fs::path& dir) {
    for (std::size_t i = 0; i < out.parts.size(); ++i) write_csv(dir / (out.parts[i] + ".csv"), out.survey.parts[i]);
    write_atomically(dir / "model.toml", model_text(out.model, out.survey));
    write_atomically(dir / "study.toml", study_text(study_name(data), out.parts, out.survey));
    draw(out.survey, out.model, out.parts, dir);
  });
  out.study = (to / "study.toml").lexically_normal();
  return out;
}

}  // namespace misfit
