#include "misfit/workflow/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "misfit/core/error.h"
#include "misfit/core/files.h"
#include "misfit/core/shell_word.h"
#include "misfit/core/shown.h"
#include "misfit/core/version.h"
#include "misfit/core/written_files.h"
#include "misfit/data/estimators.h"
#include "misfit/export/model_formulas.h"
#include "misfit/workflow/ladder.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

struct Format {
  const char* name;
  const char* file;  ///< in export/ of the run folder; empty: several, by their own names
  std::string (*text)(const Exported&);
};
constexpr Format formats[] = {{"json", "estimate.json", json_text},
                              {"csv", "", nullptr},
                              {"c", "model.c", c_source},
                              {"python", "model.py", python_source},
                              {"jsbsim", "aerodynamics.xml", jsbsim_text}};

const Format& format_of(const std::string& name) {
  const auto found = std::find_if(std::begin(formats), std::end(formats), [&](const Format& f) { return name == f.name; });
  if (found == std::end(formats)) throw InputError("--to " + shown(name) + ": no such format" + suggest(name, export_formats()));
  return *found;
}

/// The study that was asked for, opened, and what it is called.
struct Chosen {
  std::unique_ptr<Session> session;
  std::string rung;
};

Chosen open(const SessionOptions& options, const Registry& registry, const std::string& asked) {
  const Session root(options, registry, RunFolder::Access::read);
  const Ladder ladder = known_ladder(root).value_or(Ladder{});
  const auto own = [&] { return Chosen{std::make_unique<Session>(options, registry), ""}; };
  if (ladder.rungs.empty()) {
    if (!asked.empty() && asked != "0") throw InputError("--rung " + shown(asked) + ": the study has no ladder yet; misfit add makes one");
    return own();
  }
  const Rung& rung = asked.empty() ? ladder.rungs.back() : find_rung(ladder.rungs, asked, "--rung ");
  if (rung.parent < 0) return own();
  const fs::path study = root.folder.file(rung.study);
  if (!fs::exists(study)) throw RunError(fmt::format("rung {} of the ladder is missing: {}", rung.id, study.string()));
  SessionOptions of_rung = options_for(options, study);
  return {std::make_unique<Session>(of_rung, registry), fmt::format("rung {}, {} added", rung.id, rung.added)};
}

/// Without what does not make it another estimate.
StageInputs essential(StageInputs inputs) {
  inputs.erase("program");
  inputs.erase("time_limit");
  inputs.erase("usual_limit");
  return inputs;
}

bool is_there(const Session& session, const std::string& method) {
  return session.folder.stages().contains("fit/" + method) && fs::exists(session.folder.file("fit/" + method + "/fit.json"));
}

std::string made_by(const Session& session, const std::string& method) {
  return misfit_command("fit", session.study.file.lexically_normal().string(), "--method " + method, session.options.out) + " makes it";
}

/// The fit of that method as it lies in the run folder.
Fit stored_fit(const Session& session, const std::string& method) {
  if (!is_there(session, method))
    throw InputError(fmt::format("{}: there is no estimate by {} yet; {}", session.folder.path().lexically_normal().string(), method,
                                 made_by(session, method)));
  const std::string stage = "fit/" + method;
  if (essential(session.folder.stages().at(stage).inputs) != essential(inputs_of_fit(session, method)) ||
      !session.folder.damaged(stage).empty())
    throw InputError(fmt::format("the estimate by {} is of another state of the study, its data or its results; {} again", method,
                                 made_by(session, method)));
  return read_fit(session.folder.file(stage));
}

Fit chosen_fit(const Session& session, const std::string& asked) {
  if (!asked.empty()) {
    Fit fit = stored_fit(session, asked);
    if (!fit.usable()) throw RunError(asked + " " + to_string(fit.status) + ": " + fit.message);
    return fit;
  }
  std::vector<std::string> names = session.methods();
  const std::string driven = random_force_estimator().name;  // discover and add estimate it, whatever the study names
  if (std::find(names.begin(), names.end(), driven) == names.end()) names.insert(names.begin(), driven);
  std::reverse(names.begin(), names.end());
  std::string why;
  for (const std::string& name : names) {
    if (!is_there(session, name)) continue;
    Fit fit = stored_fit(session, name);
    if (fit.usable()) return fit;
    why += (why.empty() ? "" : "; ") + name + " " + to_string(fit.status) + ": " + fit.message;
  }
  if (!why.empty()) throw RunError("no estimate to export: " + why);
  throw InputError(fmt::format("{}: there is no estimate to export yet; {} makes one", session.folder.path().lexically_normal().string(),
                               misfit_command("run", session.study.file.lexically_normal().string(), "", session.options.out)));
}

Model model_at(Session& session, const Fit& fit) {
  Model model = prepare(session).model;
  for (Parameter& p : model.parameters) {
    const auto estimate = fit.parameters.find(p.name);
    if (estimate != fit.parameters.end()) {
      p.value = estimate->second.value;
    } else if (p.free) {
      throw InputError(
          fmt::format("the estimate by {} has no parameter '{}' of the model; {} again", fit.method, p.name, made_by(session, fit.method)));
    }
  }
  return model;
}

struct Opened {
  std::unique_ptr<Session> session;
  Exported exported;
};

Opened opened_estimate(const SessionOptions& options, const Registry& registry, const ExportRequest& request) {
  if (!request.method.empty() && find_estimator(request.method) == nullptr)
    throw InputError("--method " + shown(request.method) + ": no such method" + suggest(request.method, estimator_names()));
  Chosen chosen = open(options, registry, request.rung);
  Exported out;
  out.study = chosen.session->study.name;
  out.rung = chosen.rung;
  out.program = std::string("misfit ") + version() + " (" + commit() + ")";
  out.fit = chosen_fit(*chosen.session, request.method);
  if (!find_estimator(out.fit.method)->regression_form) out.model = model_at(*chosen.session, out.fit);
  use_plain_units(out);
  return {std::move(chosen.session), std::move(out)};
}

using Texts = std::map<std::string, std::string>;

Texts texts_of(const Format& format, const Exported& exported, const fs::path& out) {
  if (format.text == nullptr) return csv_texts(exported);
  return {{out.empty() ? format.file : out.filename().string(), format.text(exported)}};
}

void write_texts(const Texts& texts, const fs::path& folder) {
  for (const auto& [name, text] : texts) write_atomically(folder / name, text);
}

/// Into the run folder, as a stage.
std::vector<fs::path> write_stage(Session& session, const std::string& stage, const Texts& texts) {
  std::vector<std::string> names;
  std::vector<fs::path> files;
  for (const auto& [name, text] : texts) {
    names.push_back("export/" + name);
    files.push_back(session.folder.file(names.back()));
  }
  session.redo_stage(stage, session.inputs(session.study.text, {}), names, [&](const fs::path& dir) {
    make_writable_folder(dir / "export");
    write_texts(texts, dir / "export");
  });
  return files;
}

/// Where the command line says.
std::vector<fs::path> write_to(const fs::path& folder, const Session& session, const Texts& texts) {
  std::vector<std::string> names;
  std::vector<fs::path> files;
  for (const auto& [name, text] : texts) {
    names.push_back(name);
    files.push_back(folder / name);
  }
  write_files(folder, {files_of_study(session.study), session.options.force}, names, [&](const fs::path& dir) { write_texts(texts, dir); });
  return files;
}

}  // namespace

std::vector<std::string> export_formats() {
  std::vector<std::string> out;
  for (const Format& format : formats) out.emplace_back(format.name);
  return out;
}

Exported exported_estimate(const SessionOptions& options, const Registry& registry, const ExportRequest& request) {
  return opened_estimate(options, registry, request).exported;
}

ExportReport export_stage(const SessionOptions& options, const Registry& registry, const ExportRequest& request) {
  const Format& format = format_of(request.format);
  if (request.out == "-" && format.text == nullptr) throw InputError("--out -: " + request.format + " is several files; --out FOLDER");
  Opened opened = opened_estimate(options, registry, request);
  const Texts texts = texts_of(format, opened.exported, request.out);
  ExportReport out;
  if (request.out.empty()) {
    out.files = write_stage(*opened.session, std::string("export/") + format.name, texts);
  } else if (request.out == "-") {
    out.text = texts.begin()->second;
  } else {
    fs::path folder = format.text == nullptr ? request.out : request.out.parent_path();
    if (folder.empty()) folder = ".";
    out.files = write_to(folder, *opened.session, texts);
  }
  const bool code = format.name == std::string("c") || format.name == std::string("python");
  if (code) out.lack = opened.exported.model ? model_formulas(*opened.exported.model).lack : "it has no model";
  if (format.name == std::string("jsbsim")) out.left_out = effects_not_in_jsbsim(opened.exported);
  out.exported = std::move(opened.exported);
  return out;
}

}  // namespace misfit
