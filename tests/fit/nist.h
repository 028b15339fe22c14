#pragma once

// Sets of the NIST Statistical Reference Datasets for nonlinear regression (StRD): model, both starts, certified values and their standard
// deviations, measurements. Where data were made from a formula (Lanczos) they are made so here.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "misfit/fit/methods.h"
#include "tests/model/declared_texts.h"

namespace misfit::testing_nist {

using Table = std::vector<std::array<double, 2>>;  ///< x, y

struct Parameter {
  double start_1, start_2, certified, sigma;
};

struct Problem {
  std::string name, formula;
  std::vector<Parameter> parameters;  ///< b1, b2, …
  Table data;
};

// clang-format off
inline const Table misra = {{77.6, 10.07}, {114.9, 14.73}, {141.1, 17.94}, {190.8, 23.93}, {239.9, 29.61}, {289.0, 35.18}, {332.8, 40.02}, {378.4, 44.82}, {434.8, 50.76}, {477.3, 55.05}, {536.8, 61.01}, {593.1, 66.4}, {689.1, 75.47}, {760.0, 81.78}};
inline const Table danwood = {{1.309, 2.138}, {1.471, 3.421}, {1.49, 3.597}, {1.565, 4.34}, {1.611, 4.882}, {1.68, 5.66}};
inline const Table boxbod = {{1.0, 109.0}, {2.0, 149.0}, {3.0, 149.0}, {5.0, 191.0}, {7.0, 213.0}, {10.0, 224.0}};
inline const Table rat42 = {{9.0, 8.93}, {14.0, 10.8}, {21.0, 18.59}, {28.0, 22.33}, {42.0, 39.35}, {57.0, 56.11}, {63.0, 61.73}, {70.0, 64.62}, {79.0, 67.08}};
inline const Table rat43 = {{1.0, 16.08}, {2.0, 33.83}, {3.0, 65.8}, {4.0, 97.2}, {5.0, 191.55}, {6.0, 326.2}, {7.0, 386.87}, {8.0, 520.53}, {9.0, 590.03}, {10.0, 651.92}, {11.0, 724.93}, {12.0, 699.56}, {13.0, 689.96}, {14.0, 637.56}, {15.0, 717.41}};
inline const Table mgh10 = {{50.0, 34780.0}, {55.0, 28610.0}, {60.0, 23650.0}, {65.0, 19630.0}, {70.0, 16370.0}, {75.0, 13720.0}, {80.0, 11540.0}, {85.0, 9744.0}, {90.0, 8261.0}, {95.0, 7030.0}, {100.0, 6005.0}, {105.0, 5147.0}, {110.0, 4427.0}, {115.0, 3820.0}, {120.0, 3307.0}, {125.0, 2872.0}};
inline const Table mgh17 = {{0.0, 0.844}, {10.0, 0.908}, {20.0, 0.932}, {30.0, 0.936}, {40.0, 0.925}, {50.0, 0.908}, {60.0, 0.881}, {70.0, 0.85}, {80.0, 0.818}, {90.0, 0.784}, {100.0, 0.751}, {110.0, 0.718}, {120.0, 0.685}, {130.0, 0.658}, {140.0, 0.628}, {150.0, 0.603}, {160.0, 0.58}, {170.0, 0.558}, {180.0, 0.538}, {190.0, 0.522}, {200.0, 0.506}, {210.0, 0.49}, {220.0, 0.478}, {230.0, 0.467}, {240.0, 0.457}, {250.0, 0.448}, {260.0, 0.438}, {270.0, 0.431}, {280.0, 0.424}, {290.0, 0.42}, {300.0, 0.414}, {310.0, 0.411}, {320.0, 0.406}};
inline const Table eckerle4 = {{400.0, 0.0001575}, {405.0, 0.0001699}, {410.0, 0.0002350}, {415.0, 0.0003102}, {420.0, 0.0004917}, {425.0, 0.0008710}, {430.0, 0.0017418}, {435.0, 0.0046400}, {436.5, 0.0065895}, {438.0, 0.0097302}, {439.5, 0.0149002}, {441.0, 0.0237310}, {442.5, 0.0401683}, {444.0, 0.0712559}, {445.5, 0.1264458}, {447.0, 0.2073413}, {448.5, 0.2902366}, {450.0, 0.3445623}, {451.5, 0.3698049}, {453.0, 0.3668534}, {454.5, 0.3106727}, {456.0, 0.2078154}, {457.5, 0.1164354}, {459.0, 0.0616764}, {460.5, 0.0337200}, {462.0, 0.0194023}, {463.5, 0.0117831}, {465.0, 0.0074357}, {470.0, 0.0022732}, {475.0, 0.0008800}, {480.0, 0.0004579}, {485.0, 0.0002345}, {490.0, 0.0001586}, {495.0, 0.0001143}, {500.0, 0.0000710}};
inline const Table mgh09 = {{4.0, 0.1957}, {2.0, 0.1947}, {1.0, 0.1735}, {0.5, 0.16}, {0.25, 0.0844}, {0.167, 0.0627}, {0.125, 0.0456}, {0.1, 0.0342}, {0.0833, 0.0323}, {0.0714, 0.0235}, {0.0625, 0.0246}};
// clang-format on

inline double sum_of_exponentials(double x) { return 0.0951 * std::exp(-x) + 0.8607 * std::exp(-3.0 * x) + 1.5576 * std::exp(-5.0 * x); }

/// With so many significant digits, at most so many of them behind the point.
inline Table lanczos(int digits, int decimals = 100) {
  constexpr int rows = 24;
  Table out;
  for (int i = 0; i < rows; ++i) {
    const double x = 0.05 * i, y = sum_of_exponentials(x);
    const int places = std::min(decimals, digits - 1 - static_cast<int>(std::floor(std::log10(y))));
    const double unit = std::pow(10.0, places);
    out.push_back({x, std::round(y * unit) / unit});
  }
  return out;
}

inline const std::vector<Problem> problems = {
    {"Misra1a",
     "b1*(1 - exp(-b2*x))",
     {{500.0, 250.0, 2.3894212918E+02, 2.7070075241E+00}, {0.0001, 0.0005, 5.5015643181E-04, 7.2668688436E-06}},
     misra},
    {"Misra1b",
     "b1*(1 - (1 + b2*x/2)^(-2))",
     {{500.0, 300.0, 3.3799746163E+02, 3.1643950207E+00}, {0.0001, 0.0002, 3.9039091287E-04, 4.2547321834E-06}},
     misra},
    {"Misra1c",
     "b1*(1 - (1 + 2*b2*x)^(-0.5))",
     {{500.0, 600.0, 6.3642725809E+02, 4.6638326572E+00}, {0.0001, 0.0002, 2.0813627256E-04, 1.7728423155E-06}},
     misra},
    {"Misra1d",
     "b1*b2*x/(1 + b2*x)",
     {{500.0, 450.0, 4.3736970754E+02, 3.6489174345E+00}, {0.0001, 0.0003, 3.0227324449E-04, 2.9334354479E-06}},
     misra},
    {"DanWood", "b1*x^b2", {{1.0, 0.7, 7.6886226176E-01, 1.8281973860E-02}, {5.0, 4.0, 3.8604055871E+00, 5.1726610913E-02}}, danwood},
    {"BoxBOD",
     "b1*(1 - exp(-b2*x))",
     {{1.0, 100.0, 2.1380940889E+02, 1.2354515176E+01}, {1.0, 0.75, 5.4723748542E-01, 1.0455993237E-01}},
     boxbod},
    {"Rat42",
     "b1/(1 + exp(b2 - b3*x))",
     {{100.0, 75.0, 7.2462237576E+01, 1.7340283401E+00},
      {1.0, 2.5, 2.6180768402E+00, 8.8295217536E-02},
      {0.1, 0.07, 6.7359200066E-02, 3.4465663377E-03}},
     rat42},
    {"Rat43",
     "b1/(1 + exp(b2 - b3*x))^(1/b4)",
     {{100.0, 700.0, 6.9964151270E+02, 1.6302297817E+01},
      {10.0, 5.0, 5.2771253025E+00, 2.0828735829E+00},
      {1.0, 0.75, 7.5962938329E-01, 1.9566123451E-01},
      {1.0, 1.3, 1.2792483859E+00, 6.8761936385E-01}},
     rat43},
    {"Lanczos1",
     "b1*exp(-b2*x) + b3*exp(-b4*x) + b5*exp(-b6*x)",
     {{1.2, 0.5, 9.5100000027E-02, 5.3347304234E-11},
      {0.3, 0.7, 1.0000000001E+00, 2.7473038179E-10},
      {5.6, 3.6, 8.6070000013E-01, 1.3576062225E-10},
      {5.5, 4.2, 3.0000000002E+00, 3.3308253069E-10},
      {6.5, 4.0, 1.5575999998E+00, 1.8815731448E-10},
      {7.6, 6.3, 5.0000000001E+00, 1.1057500538E-10}},
     lanczos(13)},
    {"Lanczos2",
     "b1*exp(-b2*x) + b3*exp(-b4*x) + b5*exp(-b6*x)",
     {{1.2, 0.5, 9.6251029939E-02, 6.6770575477E-04},
      {0.3, 0.7, 1.0057332849E+00, 3.3989646176E-03},
      {5.6, 3.6, 8.6424689056E-01, 1.7185846685E-03},
      {5.5, 4.2, 3.0078283915E+00, 4.1707005856E-03},
      {6.5, 4.0, 1.5529016879E+00, 2.3744381417E-03},
      {7.6, 6.3, 5.0028798100E+00, 1.3958787284E-03}},
     lanczos(6)},
    {"Lanczos3",
     "b1*exp(-b2*x) + b3*exp(-b4*x) + b5*exp(-b6*x)",
     {{1.2, 0.5, 8.6816414977E-02, 1.7197908859E-02},
      {0.3, 0.7, 9.5498101505E-01, 9.7041624475E-02},
      {5.6, 3.6, 8.4400777463E-01, 4.1488663282E-02},
      {5.5, 4.2, 2.9515951832E+00, 1.0766312506E-01},
      {6.5, 4.0, 1.5825685901E+00, 5.8371576281E-02},
      {7.6, 6.3, 4.9863565084E+00, 3.4436403035E-02}},
     lanczos(5, 4)},
    {"MGH09",
     "b1*(x^2 + x*b2)/(x^2 + x*b3 + b4)",
     {{25.0, 0.25, 1.9280693458E-01, 1.1435312227E-02},
      {39.0, 0.39, 1.9128232873E-01, 1.9633220911E-01},
      {41.5, 0.415, 1.2305650693E-01, 8.0842031232E-02},
      {39.0, 0.39, 1.3606233068E-01, 9.0025542308E-02}},
     mgh09},
    {"MGH10",
     "b1*exp(b2/(x + b3))",
     {{2.0, 0.02, 5.6096364710E-03, 1.5687892471E-04},
      {400000.0, 4000.0, 6.1813463463E+03, 2.3309021107E+01},
      {25000.0, 250.0, 3.4522363462E+02, 7.8486103508E-01}},
     mgh10},
    {"MGH17",
     "b1 + b2*exp(-x*b4) + b3*exp(-x*b5)",
     {{50.0, 0.5, 3.7541005211E-01, 2.0723153551E-03},
      {150.0, 1.5, 1.9358469127E+00, 2.2031669222E-01},
      {-100.0, -1.0, -1.4646871366E+00, 2.2175707739E-01},
      {1.0, 0.01, 1.2867534640E-02, 4.4861358114E-04},
      {2.0, 0.02, 2.2122699662E-02, 8.9471996575E-04}},
     mgh17},
    {"Eckerle4",
     "b1/b2*exp(-0.5*((x - b3)/b2)^2)",
     {{1.0, 1.5, 1.5543827178E+00, 1.5408051163E-02},
      {10.0, 5.0, 4.0888321754E+00, 4.6803020753E-02},
      {500.0, 450.0, 4.5154121844E+02, 4.6800518816E-02}},
     eckerle4}};

/// y = f(x; b) as a system with an output only: one state that stands, x as an input, the row as time.
inline std::string text_of(const Problem& problem) {
  std::string out = "[states]\ns = { unit = \"-\", initial = 0.0 }\n[inputs]\nx = { unit = \"-\" }\n[parameters]\n";
  for (std::size_t k = 1; k <= problem.parameters.size(); ++k)
    out += "b" + std::to_string(k) + " = { unit = \"-\", value = 1.0, free = true }\n";
  return out + "[equations]\ns = \"0\"\n[outputs]\ny = { unit = \"-\", formula = \"" + problem.formula + "\" }\n";
}

inline std::vector<Signals> measurements(const Problem& problem) {
  Signals s;
  s.name = "table";
  s.measured = {{"y", "-", {}, 0.0}};
  s.inputs = {{"x", "-", {}, 0.0}};
  for (const auto& [x, y] : problem.data) {
    s.t.push_back(static_cast<double>(s.t.size()));
    s.inputs[0].values.push_back(x);
    s.measured[0].values.push_back(y);
  }
  return {s};
}

/// By output_error as a study has it, from start 1 or 2.
inline Fit fitted(const Problem& problem, int start) {
  const auto known = testing_models::registry_with(text_of(problem));
  ModelRequest request = testing_models::request_of("text");
  for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
    const Parameter& b = problem.parameters[k];
    request.parameters["b" + std::to_string(k + 1)].value = start == 1 ? b.start_1 : b.start_2;
  }
  const Model model = assemble(request, *known);
  const std::vector<Signals> experiments = measurements(problem);
  return estimator("output_error").run({model, experiments}).at.fitted.fit;
}

/// Digits of the worst parameter, and of the worst standard deviation, that agree with the certified ones.
struct Digits {
  double value = 15.0, sigma = 15.0;
};

inline double common_digits(double value, double certified) {
  constexpr double all = 1e-15;
  return -std::log10(std::max(std::abs(value / certified - 1.0), all));
}

inline Digits digits(const Fit& fit, const Problem& problem) {
  Digits out;
  for (std::size_t k = 0; k < problem.parameters.size(); ++k) {
    const std::string name = "b" + std::to_string(k + 1);
    out.value = std::min(out.value, common_digits(fit.parameters.at(name).value, problem.parameters[k].certified));
    out.sigma = std::min(out.sigma, common_digits(fit.plain_sigmas.at(name), problem.parameters[k].sigma));
  }
  return out;
}

}  // namespace misfit::testing_nist
