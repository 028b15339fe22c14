// A plain integrator: classical Runge-Kutta of fixed step, inputs and sensors worked out on its grid.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/benchmark/strangers/world.h"

namespace strangers {
namespace {

using Series = std::vector<double>;
constexpr int lead = 60;  ///< samples before the recording begins: delays and lags have a past

double deviation(const Series& y) {
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
  double sum = 0.0;
  for (double v : y) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / static_cast<double>(y.size()));
}

/// Steps of random height, a two-level sequence, or a sum of sines, between low and high.
Series excitation(const World& world, const Channel& channel, int number) {
  Dice dice(world.system->name + " input " + channel.name, world.seed + 1000003 * number);
  const double middle = 0.5 * (channel.low + channel.high), half = 0.5 * (channel.high - channel.low);
  const double slowest = world.system->slowest * (channel.slow ? 6.0 : 1.0);
  Series u(static_cast<std::size_t>(world.samples + lead));
  if (world.held) {
    const bool two_levels = dice.uniform(0, 1) < 0.3;
    double level = middle, until = -1.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
      if (static_cast<double>(i) * world.step > until) {
        level = middle + half * (two_levels ? (dice.uniform(0, 1) < 0.5 ? -0.8 : 0.8) : dice.uniform(-1, 1));
        until = static_cast<double>(i) * world.step + slowest * dice.uniform(0.3, 3.0);
      }
      u[i] = level;
    }
    return u;
  }
  constexpr int lines = 7;
  for (int line = 0; line < lines; ++line) {
    const double rate = dice.draw({"", 0.15 / slowest, 2.5 / slowest}), phase = dice.uniform(0, 2 * std::numbers::pi);
    for (std::size_t i = 0; i < u.size(); ++i) u[i] += std::sin(rate * static_cast<double>(i) * world.step + phase);
  }
  const double size = std::max(-*std::min_element(u.begin(), u.end()), *std::max_element(u.begin(), u.end()));
  for (double& v : u) v = middle + half * v / size;
  return u;
}

/// What the plant feels of a recorded input, at every half step.
Series felt(const Series& recorded, const World& world, const Values& hidden, int parts) {
  Series u(recorded.size() * static_cast<std::size_t>(2 * parts) + 1);
  const double half_step = world.step / (2.0 * parts);
  double play = recorded.front(), slewed = recorded.front(), wanted = recorded.front();
  for (std::size_t k = 0; k < u.size(); ++k) {
    const double at = std::max((static_cast<double>(k) * half_step - hidden("delay")) / world.step + 1e-9, 0.0);
    const std::size_t i = std::min(static_cast<std::size_t>(at), recorded.size() - 1), next = std::min(i + 1, recorded.size() - 1);
    double v = world.held ? recorded[i] : recorded[i] + (recorded[next] - recorded[i]) * (at - static_cast<double>(i));
    v += hidden("offset");
    if (hidden("limit") > 0.0) v = std::clamp(v, -hidden("limit"), hidden("limit"));
    if (hidden("play") > 0.0) v = play = std::clamp(play, v - hidden("play"), v + hidden("play"));
    if (hidden("slew") > 0.0) {  // towards what was wanted until now
      slewed += std::clamp(wanted - slewed, -hidden("slew") * half_step, hidden("slew") * half_step);
      wanted = v;
      v = slewed;
    }
    u[k] = v;
  }
  return u;
}

/// What a sensor makes of its output on the fine grid; `ends`: the output at the end of each step, before a held input changes.
void distort(Series& y, const Series& ends, const Values& hidden, double h) {
  const Series clean = y;
  const double largest = *std::max_element(clean.begin(), clean.end());
  double lagged = clean.front();
  for (std::size_t k = 0; k < y.size(); ++k) {
    const double at = std::max(static_cast<double>(k) - hidden("delay") / h, 0.0);
    const std::size_t i = static_cast<std::size_t>(at), next = std::min(i + 1, y.size() - 1);
    double v = clean[i] + (clean[next] - clean[i]) * (at - static_cast<double>(i));
    if (hidden("lag") > 0.0 && k > 0) lagged += (0.5 * (clean[k - 1] + ends[k - 1]) - lagged) * (1.0 - std::exp(-h / hidden("lag")));
    if (hidden("lag") > 0.0) v = lagged;
    v *= 1.0 + hidden("fading") * h * static_cast<double>(k);
    if (hidden("curve") != 0.0) v += hidden("curve") * v * v / largest;
    if (hidden("folded") > 0.0) v = std::abs(v);
    v += hidden("bias");
    if (hidden("ceiling") != 0.0) v = std::min(v, hidden("ceiling"));
    y[k] = v;
  }
}

struct Run {
  const World& world;
  std::vector<Series> recorded;         ///< inputs, per sample
  Values plant;                         ///< parameters and what is hidden in the plant
  std::vector<Values> inputs, sensors;  ///< what is hidden in each
  std::vector<Series> disturbances;     ///< of each disturbed state, per sample [unit/s]
  int parts = 1;
  std::vector<Series> outputs;    ///< on the fine grid, at the beginning of each step
  std::vector<Series> ends;       ///< and at its end, with the same inputs if they are held
  std::vector<double> rate_size;  ///< rms rate of every state
};

double disturbance_at(const Series& d, double sample) {
  const std::size_t i = std::min(static_cast<std::size_t>(sample), d.size() - 1), next = std::min(i + 1, d.size() - 1);
  return d[i] + (d[next] - d[i]) * (sample - static_cast<double>(i));
}

void integrate(Run& run) {
  const System& system = *run.world.system;
  const std::size_t n = system.initial.size(), steps = run.recorded.front().size() * static_cast<std::size_t>(run.parts);
  const double h = run.world.step / run.parts;
  std::vector<Series> u;
  for (std::size_t i = 0; i < run.recorded.size(); ++i) u.push_back(felt(run.recorded[i], run.world, run.inputs[i], run.parts));
  Series x = system.initial, k[4], trial(n), input(u.size()), y(system.outputs.size());
  for (auto& slope : k) slope.resize(n);
  run.outputs.assign(system.outputs.size(), {});
  run.ends = run.outputs;
  run.rate_size.assign(n, 0.0);
  constexpr double reach[] = {0.0, 0.5, 0.5, 1.0};
  for (std::size_t s = 0; s < steps; ++s) {
    for (std::size_t stage = 0; stage < 4; ++stage) {
      for (std::size_t j = 0; j < n; ++j) trial[j] = x[j] + (stage == 0 ? 0.0 : h * reach[stage] * k[stage - 1][j]);
      const std::size_t at = 2 * s + (run.world.held ? 1 : static_cast<std::size_t>(2 * reach[stage]));
      for (std::size_t i = 0; i < u.size(); ++i) input[i] = u[i][at];
      run.plant.numbers["t"] = (static_cast<double>(s) + reach[stage]) * h - lead * run.world.step;
      system.equations(trial.data(), input.data(), run.plant, k[stage].data(), y.data());
      for (std::size_t d = 0; d < run.disturbances.size(); ++d)
        k[stage][static_cast<std::size_t>(system.disturbed[d])] +=
            disturbance_at(run.disturbances[d], (static_cast<double>(s) + reach[stage]) / run.parts);
      if (stage > 0) continue;
      for (std::size_t o = 0; o < y.size(); ++o) run.outputs[o].push_back(y[o]);
      for (std::size_t j = 0; j < n; ++j) run.rate_size[j] += k[0][j] * k[0][j] / static_cast<double>(steps);
    }
    for (std::size_t j = 0; j < n; ++j) x[j] += h / 6.0 * (k[0][j] + 2 * k[1][j] + 2 * k[2][j] + k[3][j]);
    system.equations(x.data(), input.data(), run.plant, trial.data(), y.data());
    for (std::size_t o = 0; o < y.size(); ++o) run.ends[o].push_back(y[o]);
  }
  for (double& size : run.rate_size) size = std::sqrt(size);
}

Run prepared(const World& world) {
  Run run{world, {}, world.parameters, {}, {}, {}, 1, {}, {}, {}};
  const System& system = *world.system;
  for (std::size_t i = 0; i < system.inputs.size(); ++i) {
    run.recorded.push_back(excitation(world, system.inputs[i], static_cast<int>(i)));
    for (double& v : run.recorded.back()) v *= system.inputs[i].factor;
  }
  run.inputs.resize(system.inputs.size());
  run.sensors.resize(system.outputs.size());
  run.parts = std::max(4, static_cast<int>(std::ceil(world.step / system.fine_step)));
  return run;
}

void hide(Run& run, const Hidden& hidden) {
  Values& into = hidden.effect.site == Site::plant   ? run.plant
                 : hidden.effect.site == Site::input ? run.inputs[static_cast<std::size_t>(hidden.effect.index)]
                                                     : run.sensors[static_cast<std::size_t>(hidden.effect.index)];
  for (const auto& [name, value] : hidden.values.numbers) into.numbers[name] = value;
}

/// Ornstein-Uhlenbeck, remembered for a fifth of the slowest time constant.
Series wandering(const World& world, int number, double size) {
  Dice dice(world.system->name + " disturbance", world.seed * 17 + number);
  const double keep = std::exp(-5.0 * world.step / world.system->slowest);
  Series d(static_cast<std::size_t>(world.samples + lead));
  double v = size * dice.normal();
  for (double& value : d) value = v = keep * v + size * std::sqrt(1 - keep * keep) * dice.normal();
  return d;
}

/// The undisturbed run without anything hidden: sizes of outputs and rates.
Run calm(const World& world) {
  Run run = prepared(world);
  integrate(run);
  return run;
}

double si_of(const std::string& name, double value, const Effect& effect, const World& world, const Run& quiet) {
  if (effect.site == Site::plant || name == "curve" || name == "folded") return value;
  if (name == "fading") return value / (world.step * world.samples);
  if (name == "delay" && effect.site == Site::input && world.held) {  // a held input changes where a step of the integration begins
    const double h = world.step / quiet.parts;
    return std::round(value * world.step / h) * h;
  }
  if (name == "delay" || name == "lag") return value * world.step;
  const auto at = static_cast<std::size_t>(effect.index);
  if (effect.site == Site::input) {
    const Channel& channel = world.system->inputs[at];
    const double size = std::max(std::abs(channel.low), std::abs(channel.high)) * channel.factor;
    return name == "slew" ? value * size / world.system->slowest : value * size;
  }
  const Series& y = quiet.outputs[at];
  if (name == "ceiling") {
    const double low = *std::min_element(y.begin(), y.end());
    return low + value * (*std::max_element(y.begin(), y.end()) - low);
  }
  return deviation(y) * (name == "step" ? value * world.noise : value);
}

std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Of each eight seeds: one without anything, one unlisted, one with two at once, and five that go round the listed effects.
void choose_hidden(World& world, Dice& dice) {
  std::vector<Effect> listed, unlisted;
  for (const auto& effect : world.system->effects) (effect.right.empty() ? unlisted : listed).push_back(effect);
  const int place = world.seed % 8, turn = world.seed / 8;
  const auto of = [](const std::vector<Effect>& list, int i) { return list[static_cast<std::size_t>(i) % list.size()]; };
  if (place == 0) {
    world.kind = "null";
  } else if (place == 1) {
    world.kind = "unlisted";
    world.hidden.push_back({of(unlisted, turn), {}});
  } else if (place == 2) {
    world.kind = "two";
    const int first = static_cast<int>(dice.uniform(0, static_cast<double>(listed.size())));
    const int away = 1 + static_cast<int>(dice.uniform(0, static_cast<double>(listed.size() - 1)));
    world.hidden.push_back({of(listed, first), {}});
    world.hidden.push_back({of(listed, first + away), {}});
  } else {
    world.kind = "effect";
    world.hidden.push_back({of(listed, turn * 5 + place - 3), {}});
  }
}

}  // namespace

Dice::Dice(const std::string& purpose, int seed) {
  for (char c : purpose) state_ = (state_ ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  state_ = mixed(state_ + static_cast<std::uint64_t>(seed) * 0x9e3779b97f4a7c15ULL);
}

double Dice::uniform(double low, double high) {
  state_ += 0x9e3779b97f4a7c15ULL;
  return low + (high - low) * static_cast<double>(mixed(state_) >> 11) * 0x1.0p-53;
}

double Dice::normal() {
  const double size = std::sqrt(-2.0 * std::log(1.0 - uniform(0, 1)));
  return size * std::cos(uniform(0, 2 * std::numbers::pi));
}

double Dice::draw(const Draw& d) {
  const double value = d.low > 0.0 ? std::exp(uniform(std::log(d.low), std::log(d.high))) : uniform(d.low, d.high);
  return d.either_sign && uniform(0, 1) < 0.5 ? -value : value;
}

namespace {

bool stays_finite(const Record& record) {
  return std::all_of(record.outputs.begin(), record.outputs.end(),
                     [](const auto& y) { return std::all_of(y.begin(), y.end(), [](double value) { return std::isfinite(value); }); });
}

/// A spring that softens lets go beyond some excursion: of what is hidden in the plant half as much, until the motion is one.
void weaken_until_the_motion_stays(World& world) {
  constexpr int most = 20;
  for (int i = 0; i < most && !stays_finite(simulate(world)); ++i) {
    for (auto& hidden : world.hidden) {
      if (hidden.effect.site != Site::plant) continue;
      for (auto& [name, value] : hidden.values.numbers) value *= 0.5;
    }
  }
}

}  // namespace

World draw_world(const System& system, int seed) {
  World world;
  world.system = &system;
  world.seed = seed;
  Dice dice(system.name, seed);
  world.samples = static_cast<int>(dice.draw({"", 500, 1500}));
  world.step = dice.draw({"", system.step_low, system.step_high});
  const double digit = std::pow(10.0, std::floor(std::log10(world.step)) - 1.0);
  world.step = std::round(world.step / digit) * digit;
  // A file does not say how its inputs run between samples: misfit init takes them as held.
  world.held = dice.uniform(0, 1) < 0.6 || system.text.empty();
  world.noise = dice.draw({"", 0.002, 0.03});
  world.disturbance = dice.uniform(0, 1) < 0.5 ? 0.0 : dice.draw({"", 0.003, 0.03});
  for (const auto& parameter : system.parameters) {
    Dice own(system.name + " parameter " + parameter.name, seed);
    const double value = own.draw(parameter);
    world.parameters.numbers[parameter.name] = value;
    world.start.numbers[parameter.name] = value * std::exp(0.25 * own.normal());
  }
  choose_hidden(world, dice);
  const Run quiet = calm(world);
  for (auto& hidden : world.hidden) {
    for (const auto& d : hidden.effect.draws) {
      Dice own(system.name + " " + hidden.effect.name + " " + d.name, seed);
      hidden.values.numbers[d.name] = si_of(d.name, own.draw(d), hidden.effect, world, quiet);
    }
  }
  weaken_until_the_motion_stays(world);
  return world;
}

Record simulate(const World& world, bool with_hidden) {
  const Run quiet = calm(world);
  Run run = prepared(world);
  if (with_hidden)
    for (const auto& hidden : world.hidden) hide(run, hidden);
  for (std::size_t d = 0; d < world.system->disturbed.size(); ++d) {
    const double size = world.disturbance * quiet.rate_size[static_cast<std::size_t>(world.system->disturbed[d])];
    run.disturbances.push_back(wandering(world, static_cast<int>(d), size));
  }
  integrate(run);
  Record record;
  record.inputs.resize(run.recorded.size());
  record.outputs.resize(run.outputs.size());
  for (int i = 0; i < world.samples; ++i) {
    record.t.push_back(i * world.step);
    for (std::size_t j = 0; j < run.recorded.size(); ++j) record.inputs[j].push_back(run.recorded[j][static_cast<std::size_t>(i + lead)]);
  }
  for (std::size_t o = 0; o < run.outputs.size(); ++o) {
    distort(run.outputs[o], run.ends[o], run.sensors[o], world.step / run.parts);
    Dice dice(world.system->name + " noise " + world.system->outputs[o].name, world.seed);
    const double sigma = world.noise * deviation(quiet.outputs[o]), step = run.sensors[o]("step");
    for (int i = 0; i < world.samples; ++i) {
      const double y = run.outputs[o][static_cast<std::size_t>((i + lead) * run.parts)] + sigma * dice.normal();
      record.outputs[o].push_back(step > 0.0 ? step * std::round(y / step) : y);
    }
  }
  return record;
}

}  // namespace strangers
