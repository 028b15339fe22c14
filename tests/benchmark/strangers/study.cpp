#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/benchmark/strangers/bench.h"

namespace strangers {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", v);
  const std::string out = text;
  return out.find_first_of(".en") == std::string::npos ? out + ".0" : out;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) text.replace(at, from.size(), to);
  return text;
}

/// "a*b/c" of names and numbers.
double product(const std::string& formula, const Values& values) {
  double result = 1.0;
  for (std::size_t at = 0; at < formula.size();) {
    const bool over = formula[at] == '/';
    if (over || formula[at] == '*') ++at;
    const std::size_t end = std::min(formula.find_first_of("*/", at), formula.size());
    const std::string word = formula.substr(at, end - at);
    const auto named = values.numbers.find(word);
    const double v = named != values.numbers.end() ? named->second : std::stod(word);
    result *= over ? 1.0 / v : v;
    at = end;
  }
  return result;
}

/// {formula} over `values`, {=formula} over `exact`.
std::string filled(const std::string& text, const Values& values, const Values& exact) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t open = text.find('{', at), close = open == std::string::npos ? open : text.find('}', open);
    const bool placeholder = close != std::string::npos && text.find_first_of(" {", open + 1) > close;
    if (open == std::string::npos) return out + text.substr(at);
    out += text.substr(at, open - at);
    if (placeholder) {
      const bool is_exact = text[open + 1] == '=';
      const std::string formula = text.substr(open + 1 + is_exact, close - open - 1 - is_exact);
      std::string value = number(product(formula, is_exact ? exact : values));
      if (!out.empty() && out.back() == '-' && value.front() == '-') out.pop_back(), value.erase(0, 1);
      out += value;
      at = close + 1;
    } else {
      out += '{';
      at = open + 1;
    }
  }
  return out;
}

std::string table(const System& system, const Record& record) {
  std::string text = "t[s]";
  for (const auto& channel : system.inputs) text += "," + channel.name + "[" + channel.unit + "]";
  for (const auto& channel : system.outputs) text += "," + channel.name + "[" + channel.unit + "]";
  for (std::size_t i = 0; i < record.t.size(); ++i) {
    text += '\n' + number(record.t[i]);
    for (std::size_t j = 0; j < system.inputs.size(); ++j) text += ',' + number(record.inputs[j][i] / system.inputs[j].factor);
    for (std::size_t j = 0; j < system.outputs.size(); ++j) text += ',' + number(record.outputs[j][i] / system.outputs[j].factor);
  }
  return text + '\n';
}

constexpr const char* own_study = R"toml([study]
name = "NAME"
question = "What does this model miss?"
methods = ["output_error"]

[system]
file = "model.toml"

[[experiment]]
name = "recording"
data = "data.csv"
validation = "last 25 %"

[effects]
)toml";

std::string model_text(const World& world, const Values& values) {
  return filled(replaced(world.system->text, "{hold}", world.held ? "zero_order" : "first_order"), values, world.parameters);
}

}  // namespace

bool write_study(const World& world, const Bench& bench, const fs::path& dir) {
  const System& system = *world.system;
  const std::string data = table(system, simulate(world));
  if (system.text.empty()) {
    write(dir / "data.csv", data);
    return run({bench.program, "init", dir / "data.csv", "--out", dir / "study", "--force"}, dir / "init.txt", bench).status == 0;
  }
  write(dir / "study/data.csv", data);
  write(dir / "study/model.toml", model_text(world, world.start));
  write(dir / "study/study.toml", replaced(own_study, "NAME", system.name));
  return true;
}

bool write_truth(const World& world, const fs::path& dir) {
  fs::create_directories(dir / "truth");
  for (const auto& entry : fs::directory_iterator(dir / "study"))
    if (entry.is_regular_file()) fs::copy_file(entry.path(), dir / "truth" / entry.path().filename(), fs::copy_options::overwrite_existing);
  if (!world.system->text.empty()) write(dir / "truth/model.toml", model_text(world, world.parameters));
  const std::string& first = world.system->outputs.front().name;
  const bool second_order = read(dir / "truth/model.toml").find("\n" + first + "_rate = {") != std::string::npos;
  std::string lines, parameters;
  for (const auto& hidden : world.hidden) {
    if (hidden.effect.truth.empty()) return false;
    Values values = world.parameters;
    for (const auto& [name, value] : hidden.values.numbers) values.numbers[name] = value;
    std::string text = replaced(filled(hidden.effect.truth, values, values), "PORT", "d" + first + (second_order ? "_rate/dt" : "/dt"));
    constexpr const char* section = "[parameters]\n";
    if (const std::size_t at = text.find(section); at != std::string::npos) {
      parameters += text.substr(at + std::string(section).size()) + '\n';
      text.erase(at);
    }
    lines += text + '\n';
  }
  if (!parameters.empty()) lines += "[parameters]\n" + parameters;
  std::ofstream(dir / "truth/study.toml", std::ios::app) << lines;
  return true;
}

void write_twin(const World& world, const fs::path& dir) {
  fs::create_directories(dir / "twin");
  for (const char* file : {"study.toml", "model.toml"})
    fs::copy_file(dir / "study" / file, dir / "twin" / file, fs::copy_options::overwrite_existing);
  if (!world.system->text.empty()) write(dir / "twin/model.toml", model_text(world, world.parameters));
  write(dir / "twin/data.csv", table(*world.system, simulate(world, false)));
}

}  // namespace strangers
