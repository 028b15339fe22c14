#pragma once

#include <cmath>
#include <cstdio>
#include <random>

#include "tests/apps/program.h"

namespace program {

/// A driven oscillator with dry friction that its model lacks, as text, in a folder of its own: every verb takes it a second or two. The
/// recording is made here by Euler steps of a fortieth of a sample, with nothing of sim/.
class OscillatorStudy {
 public:
  OscillatorStudy() {
    write("d.csv", recording());
    write("m.toml", R"([system]
doc = "an oscillator"
[states]
y = { unit = "m", initial = "free" }
w = { unit = "m/s", rate_of = "y", initial = "free" }
[inputs]
u = { unit = "N", hold = "zero_order" }
[parameters]
k = { unit = "1/s^2", value = 3.0, bounds = [0.01, 100.0], free = true }
c = { unit = "1/s", value = 0.5, bounds = [0.0, 10.0], free = true }
g = { unit = "1/kg", value = 1.0, free = true }
[equations]
w = "g*u - k*y - c*w"
[outputs]
y = { unit = "m", noise = 0.005 }
[roles]
rate = "w"
)");
    write("study.toml", R"([study]
name = "an oscillator"
question = "What does it lack?"
methods = ["output_error", "filter_error"]
seed = 1
[system]
file = "m.toml"
[[experiment]]
name = "steps"
data = "d.csv"
validation = "last 25 %"
[effects]
[uncertainty]
bootstrap = 40
profile = ["k"]
starts = 5
)");
    for (const char* name : {"one", "two", "three"}) {
      fs::create_directories(path(std::string("batch/") + name));
      for (const char* file : {"d.csv", "m.toml", "study.toml"}) fs::copy_file(path(file), path(std::string("batch/") + name) / file);
    }
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }

  /// Records it anew, half as long again, with another force in place of dry friction, a function of its rate [m/s].
  void record_with(double (*force)(double)) const { write("d.csv", recording(force, 600)); }

  /// Its position is measured by two sensors: an effect of a sensor has two places.
  void measure_twice() const {
    std::istringstream lines(content(path("d.csv")));
    std::mt19937 random(4);
    std::normal_distribution<double> noise(0.0, 0.005);
    std::string text, line;
    std::getline(lines, line);
    text = line + ",y2[m]\n";
    while (std::getline(lines, line))
      text += line + "," + std::to_string(std::stod(line.substr(line.rfind(',') + 1)) + noise(random)) + "\n";
    write("d.csv", text);
    const std::string model = content(path("m.toml"));
    write("m.toml", std::regex_replace(model, std::regex("noise = 0.005 \\}"),
                                       "noise = 0.005 }\ny2 = { unit = \"m\", formula = \"y\", noise = 0.007 }"));
  }

  /// The words of a command that does all that VERB can do, with its results in `out`.
  [[nodiscard]] std::vector<std::string> command(const std::string& verb, const fs::path& out) const {
    const std::string study = path(verb == "batch" ? "batch" : "study.toml").string();
    std::vector<std::string> words{verb, study, "--out", out.string(), "--quiet"};
    if (verb == "discover") words.emplace_back("--auto");
    return words;
  }

 private:
  static double dry_friction(double w) { return -0.5 * std::tanh(w / 0.02); }

  static std::string recording(double (*force)(double) = dry_friction, int samples = 400) {
    std::string text = "t[s],u[N],y[m]\n";
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 0.005);
    constexpr int steps = 40;
    constexpr double dt = 0.05, h = dt / steps;
    double y = 0.5, w = 0.0;
    for (int i = 0; i < samples; ++i) {
      const double u = (i / 60) % 2 == 0 ? 1.0 : -1.0;
      char row[80];
      std::snprintf(row, sizeof row, "%.3f,%.1f,%.5f\n", i * dt, u, y + noise(random));
      text += row;
      for (int k = 0; k < steps; ++k) {
        w += h * (-4.0 * y - 0.2 * w + 2.0 * u + force(w));
        y += h * w;
      }
    }
    return text;
  }

  TemporaryFolder folder_;
};

inline std::string without(std::string text, const std::string& part) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at)) text.erase(at, part.size());
  return text;
}

/// Every file below `folder` but run.json; "seconds" of JSON, reports' times and the folder's own name left out: name → content.
inline std::map<std::string, std::string> results_in(const fs::path& folder) {
  static const std::regex times(R"("seconds": [-+.0-9e]+)");
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string(), file = entry.path().filename().string();
    if (!entry.is_regular_file() || file == "run.json" || file == ".run.json" || file.ends_with(".bin")) continue;
    if (file == "report.html") {
      out[name] = "";  // contains how long the stages took
      continue;
    }
    out[name] = without(std::regex_replace(content(entry.path()), times, ""), folder.string());
  }
  return out;
}

/// Files that differ, or are in one folder only.
inline std::vector<std::string> differences(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b) {
  std::vector<std::string> names;
  for (const auto& [name, text] : a) {
    if (const auto other = b.find(name); other == b.end() || other->second != text) names.push_back(name);
  }
  for (const auto& [name, text] : b) {
    if (!a.contains(name)) names.push_back(name);
  }
  return names;
}

}  // namespace program
