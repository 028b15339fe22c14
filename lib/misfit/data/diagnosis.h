#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace misfit {

/// Are the innovations of one channel independent of each other? Standardised: value/sigma.
struct WhitenessReport {
  std::string experiment, channel;
  std::vector<double> autocorrelation;  ///< of lag 0, 1, …
  double band = 0.0;                    ///< 95 % band of a white sequence
  int lags = 0;                         ///< in the Ljung–Box sum
  double ljung_box = 0.0, ljung_box_p = 1.0;
  std::vector<double> frequency, power;           ///< periodogram [Hz], power relative to white (1)
  double periodogram_p = 1.0;                     ///< largest departure of the cumulative periodogram (Kolmogorov–Smirnov)
  double peak_frequency = 0.0, peak_power = 0.0;  ///< the highest line
  double peak_p = 1.0;                            ///< corrected for the number of frequencies (Fisher's g)
};

/// Seconds of a recording: the only quantity of a map that has a first and a last value.
inline constexpr const char* time_of_recording = "time";

/// Force on a port that the data ask for, by place of a quantity: amplitude of hat functions on top of the fitted model, free parameters
/// projected out.
struct ForceMap {
  std::string port, port_unit, quantity, quantity_unit;
  std::vector<double> x;                 ///< places of the hats [quantity_unit]
  std::vector<double> amplitude, sigma;  ///< [port_unit]
  std::vector<double> count;             ///< samples under each hat
  double chi2 = 0.0;
  int dof = 0;
  double p_value = 1.0;      ///< of this map alone
  double p_corrected = 1.0;  ///< for the number of maps (Šidák)
  std::string sentence;  ///< "the in-plane moment is 41 ± 6 N m too high where phi is between −115 and −65 deg"; empty: nothing there
};

/// The same over two quantities at once, cells instead of hats.
struct PairMap {
  std::string port, port_unit, quantity_x, unit_x, quantity_y, unit_y;
  std::vector<double> x, y;              ///< cell centres
  std::vector<double> amplitude, sigma;  ///< x-major; NaN where too few samples
  double chi2 = 0.0;
  int dof = 0;
  double p_value = 1.0, p_corrected = 1.0;
};

/// The smoothed random force of one experiment over time, with every quantity beside. Its dependence on motion quantities is expected even
/// when nothing is missing (the force causes the motion), so it carries no p-value.
struct MissingForce {
  std::string experiment;
  std::vector<double> t;
  std::vector<std::string> ports, port_units;
  std::vector<std::vector<double>> force, sigma;  ///< per port
  std::vector<std::string> quantities, quantity_units;
  std::vector<std::vector<double>> values;  ///< per quantity
};

/// A missing force that is there for short stretches only (pulses.h).
struct ForcePulses {
  std::string experiment, port, port_unit;
  std::vector<double> begin, end;  ///< [s]
  std::vector<double> peak;        ///< largest departure from the median [port_unit]
  std::string sentence;            ///< "what is missing on dT/dt comes in 11 pulses of …"
};

/// Normalised innovation squared over time, averaged over windows, with the band of a right model.
struct NisSeries {
  std::string experiment;
  std::vector<double> t, nis;
  double lower = 0.0, upper = 0.0;  ///< 95 % band of one window
  double outside = 0.0;             ///< share of windows outside (0.05 expected)
};

/// Where a fit fails.
struct Diagnosis {
  std::string method;
  std::vector<WhitenessReport> whiteness;
  std::vector<ForceMap> maps;  ///< most significant first
  std::vector<PairMap> pairs;
  std::vector<NisSeries> nis;
  std::vector<MissingForce> missing;
  std::optional<std::vector<ForcePulses>> pulses;  ///< none, or a map says where they come
  std::vector<std::string> sentences;              ///< plain conclusions, most important first
  double seconds = 0.0;
};

/// nullptr: there is no such map.
[[nodiscard]] const ForceMap* find_map(const Diagnosis& diagnosis, const std::string& port, const std::string& quantity);

/// diagnosis.json (everything but the missing force) and missing_force.csv (missing_force_NAME.csv for further experiments).
void write_diagnosis(const std::filesystem::path& dir, const Diagnosis& diagnosis);
[[nodiscard]] Diagnosis read_diagnosis(const std::filesystem::path& dir);

}  // namespace misfit
