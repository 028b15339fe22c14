// misfit in a program of one's own: fits a study, adds the effects that its model is missing, and prints a curve with its 95 % band.
#include <misfit/misfit.h>
#include <misfit_models_registry.h>

#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 4) throw misfit::InputError("usage: identify STUDY.toml RUN_FOLDER CURVE");
  misfit::Registry registry;
  misfit_models_register(registry);
  misfit::Identification study({.study = argv[1], .out = argv[2]}, registry);

  misfit::Discovery discovery = study.discover();
  for (auto next = study.accepted(discovery); next; next = study.accepted(discovery)) {
    const misfit::Rung& rung = study.add(*next);
    std::cout << "added " << rung.added << ", 2 * gain in log-likelihood " << rung.actual_drop.value_or(0.0) << '\n';
    discovery = study.discover();
  }
  std::cout << discovery.verdict << '\n';

  const misfit::Fit fit = study.fit("filter_error");
  const misfit::CurveEstimate& curve = misfit::curve(fit, argv[3]);
  std::cout << curve.of << " [" << curve.of_unit << "], " << curve.name << " [" << curve.unit << "], 95 % band\n";
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    if (curve.count[i] > 0.0) std::cout << curve.x[i] << ' ' << curve.value[i] << " ± " << 1.96 * curve.sigma[i] << '\n';
  }
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
