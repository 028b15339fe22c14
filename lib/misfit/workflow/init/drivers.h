#pragma once

#include "misfit/recording/recording.h"

namespace misfit {

/// Columns that survey_recording() took for outputs, but that are measured inputs (the weather, a rudder): no other column helps
/// to predict them, and they go on by themselves, or help to predict an output that others move (fit/regression/influence.h). One output
/// always stays. Of "t_in" and "t_out", which may be rooms and weather or the two ends of a pipe, the second is an input where the data do
/// not say that the first is one. The only current in a file of motions without any input drives them.
void take_measured_inputs(RecordingSurvey& survey);

}  // namespace misfit
