#include "misfit/discover/beside_a_curve.h"

#include <algorithm>
#include <string>

#include "misfit/core/lists.h"
#include "misfit/discover/unknown_form.h"
#include "misfit/math/decompositions.h"

namespace misfit {
namespace {

/// A curve of unknown form in the model, and what it would add with more knots.
struct FinerCurve {
  std::string effect, quantity;
  Eigen::MatrixXd columns;
};

/// nullptr: it has none.
const Curve* curve_of(const Model& model, const BoundEffect& effect) {
  for (const BoundCoefficient& c : effect.coefficients) {
    if (c.curve >= 0) return &model.curves[c.curve];
  }
  return nullptr;
}

FinerCurve finer(const ScoreWork& work, const BoundEffect& effect, const Curve& curve) {
  FinerCurve out{effect.name, curve.of, {}};
  const int port = effect.ports.front();
  const int index = effect.kind == PortKind::quantity ? place_of(work.force.parameters(), port) : port;
  if (index < 0) return out;
  for (const int most : {24, 72}) {
    for (const Features& hats : features_of(work.estimate, work.force, most)) {
      if (hats.index != curve.quantity) continue;
      const Eigen::MatrixXd more = work.force.columns_at(effect.kind, index, hats.f, hats.ahead);
      out.columns = out.columns.size() == 0 ? more : beside(out.columns, more);
    }
  }
  return out;
}

std::vector<FinerCurve> finer_curves(const ScoreWork& work) {
  std::vector<FinerCurve> out;
  const Model& model = work.estimate.model;
  for (const BoundEffect& effect : model.effects) {
    const Curve* curve = effect.effect->spec().has_unknown_form() ? curve_of(model, effect) : nullptr;
    if (curve == nullptr) continue;
    FinerCurve fine = finer(work, effect, *curve);
    if (fine.columns.size() > 0) out.push_back(std::move(fine));
  }
  return out;
}

}  // namespace

void leave_out_what_a_finer_curve_describes(const ScoreWork& work, std::vector<RankedCandidate>& ranked) {
  constexpr double described_below = 0.01;
  for (const FinerCurve& curve : finer_curves(work)) {
    const Eigen::MatrixXd known = column_space(beside(columns_of_parameters(work.estimate), curve.columns));
    for (RankedCandidate& e : ranked) {
      const Eigen::MatrixXd& own = e.screening->columns;
      if (e.candidate.absorbed || !e.screening->runs || own.size() == 0) continue;
      const Eigen::RowVectorXd left = (own - known * (known.transpose() * own)).colwise().squaredNorm();
      if ((left.array() >= described_below * own.colwise().squaredNorm().array()).any()) continue;
      e.candidate.absorbed = true;
      e.candidate.why = curve.effect + ", a curve of " + curve.quantity + " of unknown form, would describe it if its knots were closer " +
                        "together (R² above 0.99)";
    }
  }
}

}  // namespace misfit
