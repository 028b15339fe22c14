#include "misfit/fit/filter/unknown_past.h"

namespace misfit {

std::vector<double> departures_of_inputs(const FilterData& data) {
  const RecordedInputs& record = data.inputs.recorded;
  std::vector<double> out(record.hold.size(), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    double squares = 0.0, count = 0.0;
    for (std::size_t k = 0; k < record.t.size(); ++k) {
      const double departure = record.value(k, static_cast<int>(i)) - record.value(0, static_cast<int>(i));
      if (data.signals->held_out(k) || !std::isfinite(departure)) continue;
      squares += departure * departure;
      count += 1.0;
    }
    out[i] = count > 0.0 ? std::sqrt(squares / count) : 0.0;
  }
  return out;
}

}  // namespace misfit
