#include "tests/benchmark/known_truth.h"

#include <Eigen/Dense>
#include <stdexcept>

namespace misfit::bench {
namespace {

/// FNV-1a of the kind, then the number.
std::uint64_t seed_of(const std::string& kind, int number) {
  std::uint64_t seed = 1469598103934665603ULL;
  for (char c : kind) seed = (seed ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return seed + static_cast<std::uint64_t>(number) * 7919ULL;
}

}  // namespace

Dice::Dice(const std::string& kind, int number) : random(seed_of(kind, number)) {}

void set(Model& model, const std::string& name, double value) {
  const int at = model.find_parameter(name);
  if (at < 0) throw std::logic_error("no parameter " + name);
  model.parameters[static_cast<std::size_t>(at)].value = value;
}

void set_curve(Model& model, const std::string& name, const std::function<double(double)>& value) {
  const Curve& curve = *model.find_curve(name);
  constexpr int points = 1000;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(points, curve.spline.size());
  Eigen::VectorXd b(points);
  for (int i = 0; i < points; ++i) {
    const double x = curve.spline.lowest() + (curve.spline.highest() - curve.spline.lowest()) * (i + 0.5) / points;
    const CurvePoint point = curve.spline.at(x);
    for (std::size_t j = 0; j < 4; ++j) A(i, point.first + static_cast<int>(j)) = point.w[j];
    b[i] = value(x);
  }
  const Eigen::VectorXd c = A.colPivHouseholderQr().solve(b);
  for (Eigen::Index i = 0; i < c.size(); ++i) model.parameters[static_cast<std::size_t>(curve.first + i)].value = c[i];
}

double curve_value(const Model& model, const std::string& name, double x) {
  const Curve& curve = *model.find_curve(name);
  const CurvePoint point = curve.spline.at(x);
  double sum = 0.0;
  for (std::size_t j = 0; j < 4; ++j) sum += point.w[j] * model.parameters[static_cast<std::size_t>(curve.first + point.first) + j].value;
  return sum;
}

bool parse(int argc, char** argv, const std::string& range, PartOptions& options, const std::map<std::string, std::string*>& more) {
  std::map<std::string, std::string*> texts = more;
  texts.insert({{"--kind", &options.kind}, {"--out", &options.out}, {"--summary", &options.summary}});
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i], value = argv[i + 1];
    const auto text = texts.find(name);
    if (text != texts.end()) {
      *text->second = value;
    } else if (name == "--seconds") {
      options.seconds = std::stod(value);
    } else if (name == "--threads") {
      options.threads = std::stoi(value);
    } else if (name == range && value.find(':') != std::string::npos) {
      options.from = std::stoi(value);
      options.to = std::stoi(value.substr(value.find(':') + 1));
    } else {
      return false;
    }
  }
  return argc % 2 == 1;
}

}  // namespace misfit::bench
