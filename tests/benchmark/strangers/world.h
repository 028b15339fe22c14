#pragma once

// Textbook systems of other trades, for the bench of strangers. A system is data: the text that a user would write, a plain right-hand
// side, inputs, outputs, and what can be hidden in it. Nothing here uses the library: its integrator and its models are what is judged.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace strangers {

/// Named numbers in SI; what is not there is 0, so that a term of a hidden effect vanishes without the effect.
struct Values {
  std::map<std::string, double, std::less<>> numbers;
  double operator()(std::string_view name) const {
    const auto found = numbers.find(name);
    return found == numbers.end() ? 0.0 : found->second;
  }
};

/// A number drawn for a world: log-uniform where low > 0, else uniform; `either_sign`: with a random sign.
struct Draw {
  std::string name;
  double low = 0.0, high = 0.0;
  bool either_sign = false;
};

enum class Site { plant, input, sensor };

/// What can be hidden. Numbers of the plant are in SI; those of an input are in units of its size, of a sensor in units of the standard
/// deviation of its output, but for times (`delay`, `lag`: in sampling intervals) and shares (`ceiling`: of the largest output, `curve`,
/// `fading`) and `step` (of the noise). resolve() turns them into SI.
struct Effect {
  std::string name;
  Site site = Site::plant;
  int index = 0;  ///< which input or output
  std::vector<Draw> draws;
  /// Answers that are right, as "key@port", the port by its beginning, "key" alone where it has no place, and "key@port;role=value" where
  /// the role must be that one. More than one where they are honestly the same thing. Empty: no effect of the registry describes it.
  std::vector<std::string> right;
  /// Lines of [effects] and [parameters] of the true model; {a*b/c}: product of values of the effect and parameters of the plant.
  std::string truth;
};

struct Channel {
  std::string name, unit;
  double factor = 1.0;           ///< SI of one unit of the file
  double low = 0.0, high = 1.0;  ///< of an input [unit of the file]
  bool slow = false;             ///< of an input: weather, not a command
};

/// Rates dx and outputs y at states x and inputs u. `p`: parameters, what is hidden in the plant, and the time "t".
using Equations = void (*)(const double* x, const double* u, const Values& p, double* dx, double* y);

struct System {
  std::string name;
  /// Text of the declared system: {name} is where a user would start a parameter, {=name} its true value, {hold} that of the inputs.
  /// Empty: misfit init writes it from the data.
  std::string text;
  std::vector<Draw> parameters;
  std::vector<double> initial;
  std::vector<Channel> inputs, outputs;
  Equations equations = nullptr;
  double slowest = 1.0;                    ///< time constant that the excitation is to show [s]
  double step_low = 0.0, step_high = 0.0;  ///< sampling interval [s]
  double fine_step = 0.0;                  ///< of the integrator, at most [s]
  std::vector<int> disturbed;              ///< states whose rates feel a random disturbance
  std::vector<Effect> effects;
};

[[nodiscard]] Equations equations_of(const std::string& system);
[[nodiscard]] System read_system(const std::string& name);
[[nodiscard]] std::vector<System> all_systems();

struct Hidden {
  Effect effect;
  Values values;  ///< SI
};

/// One drawn world: system, what is hidden, truth, excitation and noise. The same (system, seed) give the same world.
struct World {
  const System* system = nullptr;
  int seed = 0;
  std::string kind;  ///< "null", "effect", "two", "unlisted"
  std::vector<Hidden> hidden;
  Values parameters, start;  ///< of the plant: truth, and where the user starts
  int samples = 0;
  double step = 0.0;
  bool held = false;         ///< inputs constant between samples, else straight lines
  double noise = 0.0;        ///< of the outputs' standard deviations
  double disturbance = 0.0;  ///< of the rms rates of the disturbed states
};

struct Record {
  std::vector<double> t;
  std::vector<std::vector<double>> inputs, outputs;  ///< as recorded, SI
};

[[nodiscard]] World draw_world(const System& system, int seed);
/// The recording of a world, with noise; `with_hidden` = false: of its twin, the same but for what is hidden.
[[nodiscard]] Record simulate(const World& world, bool with_hidden = true);

/// Random numbers that are the same on every machine.
class Dice {
 public:
  explicit Dice(const std::string& purpose, int seed);
  double uniform(double low, double high);
  double normal();
  double draw(const Draw& draw);

 private:
  std::uint64_t state_ = 1469598103934665603ULL;
};

}  // namespace strangers
