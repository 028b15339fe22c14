#pragma once

#include "misfit/core/table.h"
#include "misfit/data/signals.h"
#include "misfit/data/study.h"
#include "misfit/model/model.h"

namespace misfit {

/// The table of an experiment's `data`: CSV as it is; of other logs (data/log/log.h) the channels of what the model measures and needs, on
/// the time base of its outputs, or of `columns.t`: inputs held or interpolated as the model says, all of it said in `notes`. InputError:
/// what read_csv(), open_log() and on_one_time_base() refuse.
[[nodiscard]] Table read_recording(const ExperimentStudy& study, const Model& model, std::vector<std::string>& notes);

/// Columns of a recording (any units, of the header or of the end of a mapped column's name: ColumnMap::values) → what a model measures and
/// is driven by, in SI. Outputs are looked for under their names in the system, through `columns`; so are inputs that the model needs. An
/// input NAME_rate that is not there is differentiated from NAME. Inputs that are angles are unwrapped, rates of angles are not. Isolated
/// outliers of outputs are set aside. Gaps of inputs are bridged linearly and the samples inside are not used; inputs with a delay are
/// shifted by it. Rows without time are dropped; time that runs backwards is an InputError with the line. All of it is said in `notes`.
/// RunError if no sample is left.
[[nodiscard]] Signals signals_from(const Table& table, const Model& model, const ExperimentStudy& study);

/// What `columns` of a recording may name: the time, outputs, inputs, and NAME for an input NAME_rate.
[[nodiscard]] std::vector<std::string> signal_names(const SystemSpec& spec);

}  // namespace misfit
