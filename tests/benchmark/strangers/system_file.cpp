#include <toml++/toml.h>

#include <numbers>
#include <stdexcept>

#include "tests/benchmark/strangers/world.h"

namespace strangers {
namespace {

double number(const toml::node& node) { return node.value<double>().value(); }
std::string text(const toml::table& table, const char* key) { return table[key].value_or(std::string()); }

template <class Make>
void each(const toml::node_view<const toml::node>& list, const Make& make) {
  if (const toml::array* array = list.as_array())
    for (const auto& item : *array) make(item);
}

std::vector<Draw> draws(const toml::node_view<const toml::node>& list, bool either_sign) {
  std::vector<Draw> out;
  if (const toml::table* table = list.as_table())
    for (const auto& [name, range] : *table)
      out.push_back({std::string(name.str()), number((*range.as_array())[0]), number((*range.as_array())[1]), either_sign});
  return out;
}

Channel channel(const toml::node& node) {
  const toml::table& table = *node.as_table();
  Channel out{text(table, "name"), text(table, "unit")};
  if (out.unit.starts_with("deg")) out.factor = std::numbers::pi / 180.0;
  out.low = table["range"][0].value_or(0.0);
  out.high = table["range"][1].value_or(0.0);
  out.slow = table["slow"].value_or(false);
  return out;
}

int index_of(const std::vector<Channel>& channels, const std::string& name) {
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (channels[i].name == name) return static_cast<int>(i);
  throw std::invalid_argument("no channel " + name);
}

Effect effect(const toml::table& table, const System& system) {
  Effect out;
  out.name = text(table, "name");
  if (table.contains("input")) {
    out.site = Site::input;
    out.index = index_of(system.inputs, text(table, "input"));
  } else if (table.contains("output")) {
    out.site = Site::sensor;
    out.index = index_of(system.outputs, text(table, "output"));
  }
  out.draws = draws(table["draws"], table["either_sign"].value_or(false));
  each(table["right"], [&](const toml::node& answer) { out.right.push_back(answer.value<std::string>().value()); });
  out.truth = text(table, "truth");
  return out;
}

}  // namespace

System read_system(const std::string& name) {
  const toml::table file = toml::parse_file(MISFIT_SOURCE_DIR "/tests/benchmark/strangers/" + name + ".toml");
  System out;
  out.name = name;
  out.equations = equations_of(name);
  out.text = text(file, "model");
  out.parameters = draws(file["parameters"], false);
  each(file["initial"], [&](const toml::node& value) { out.initial.push_back(number(value)); });
  each(file["disturbed"], [&](const toml::node& state) { out.disturbed.push_back(static_cast<int>(number(state))); });
  each(file["inputs"], [&](const toml::node& node) { out.inputs.push_back(channel(node)); });
  each(file["outputs"], [&](const toml::node& node) { out.outputs.push_back(channel(node)); });
  out.slowest = file["slowest"].value_or(1.0);
  out.fine_step = file["fine_step"].value_or(1.0);
  out.step_low = file["step"][0].value_or(1.0);
  out.step_high = file["step"][1].value_or(1.0);
  each(file["effect"], [&](const toml::node& node) { out.effects.push_back(effect(*node.as_table(), out)); });
  return out;
}

std::vector<System> all_systems() {
  std::vector<System> out;
  for (const char* name : {"dc_motor", "motor_speed", "servo", "drone_roll", "quarter_car", "hydraulic_cylinder", "two_mass_drive",
                           "cart_pendulum", "thermal_house", "heat_exchanger", "battery", "ship_yaw", "chemostat"})
    out.push_back(read_system(name));
  return out;
}

}  // namespace strangers
