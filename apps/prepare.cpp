#include "apps/stages.h"
#include "misfit/core/error.h"
#include "misfit/fit/curves.h"
#include "misfit/model/curve_table.h"
#include "misfit/model/experiment.h"

namespace misfit {
namespace {

constexpr int default_intervals = 16;  // per curve: enough for any bend the data can show; roughness does the rest

/// A model in which any knots stand for those still to be chosen: to read signals, which need the system and not the curves.
Model provisional(ModelRequest request, const Registry& registry) {
  for (const auto& [name, of] : curves_without_knots(request, registry)) {
    request.curves[name].of = of;
    request.curves[name].knots = {1.0, 2.0};
  }
  return assemble(request, registry);
}

std::vector<Signals> read_experiments(Session& session, const Model& model) {
  std::vector<Signals> out;
  const std::vector<std::optional<Attitude>> attitudes = attitude_stage(session);
  for (std::size_t e = 0; e < session.study.experiments.size(); ++e) {
    const ExperimentStudy& experiment = session.study.experiments[e];
    if (attitudes[e]) {
      ExperimentStudy plain = experiment;
      plain.columns = {};  // the map was for the track's columns
      out.push_back(signals_from(attitude_table(*attitudes[e]), model, plain));
    } else {
      out.push_back(signals_from(read_csv(*experiment.data), model, experiment));
    }
  }
  return out;
}

void start_from_tables(const Session& session, Model& model) {
  for (const auto& [name, curve] : session.study.curves) {
    const Curve* target = model.find_curve(name);
    if (!curve.table || target == nullptr) continue;
    const Table table = read_csv(*curve.table);
    static_cast<void>(set_curve(model, name, table.values(curve.of, target->of_unit), table.values(name, target->unit)));
  }
}

Prepared prepare_request(Session& session, ModelRequest request) {
  if (session.study.experiments.empty())
    throw InputError({session.study.file.string(), 0, 0}, "the study has no [[experiment]]: there is nothing to fit");
  Prepared out;
  out.experiments = read_experiments(session, provisional(request, session.registry));
  choose_all_knots(request, session.registry, out.experiments, default_intervals);
  out.model = assemble(request, session.registry);
  out.request = std::move(request);
  start_from_tables(session, out.model);
  return out;
}

}  // namespace

Prepared prepare(Session& session) { return prepare_request(session, session.model.request); }

std::optional<Prepared> prepare_regression(Session& session, std::vector<std::string>& left_out) {
  auto request = regression_form(session.model.request, session.registry, left_out);
  if (!request) return std::nullopt;
  return prepare_request(session, std::move(*request));
}

bool averaged_by_attitude(const Session& session) { return session.study.experiments.front().track.has_value(); }

}  // namespace misfit
