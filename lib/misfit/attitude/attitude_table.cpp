#include <cmath>
#include <limits>

#include "misfit/attitude/attitude.h"
#include "misfit/math/angle.h"

namespace misfit {

Table attitude_table(const Attitude& a) {
  Table table;
  table.source = "attitude";
  table.add("t", "s", a.t);
  table.add("theta", "rad", a.theta);
  table.add("psi", "rad", a.psi);
  table.add("alpha", "rad", a.alpha);
  table.add("beta", "rad", a.beta);
  table.add("alpha_T", "rad", a.alpha_T);
  table.add("eta", "rad", a.eta);
  table.add("phi", "rad", unwrapped(a.phi));
  std::vector<double> rate(a.t.size(), std::nan(""));
  for (std::size_t i = 0; i < a.t.size(); ++i) {
    const double y = std::tan(a.psi_mean[i]), z = std::tan(a.theta_mean[i]);
    const double y_rate = (1.0 + y * y) * a.psi_rate[i], z_rate = (1.0 + z * z) * a.theta_rate[i];
    const double square = y * y + z * z;
    if (square > 0.0) rate[i] = (y_rate * z - y * z_rate) / square;
  }
  table.add("phi_rate", "rad/s", rate);
  return table;
}

}  // namespace misfit
