#pragma once

#include <map>
#include <string>
#include <vector>

#include "misfit/model/effect.h"
#include "misfit/model/system.h"

namespace misfit {

/// Bindings of roles, as a study would write them.
using Roles = std::map<std::string, std::string>;

/// One of its ports takes any unit.
[[nodiscard]] bool is_generic(const EffectSpec& effect);

/// Where in a system an effect could act: first its default roles ({}), then, for a generic effect, every place that the system itself
/// suggests. `port` is each port of the random force, and each port that a system with a default for `signal` declares. A conjugate that is
/// a state is its `rate`, and what it is the rate of `displacement` and `level`; one that is the rate of nothing is its `level`, and its
/// `rate` too if its unit is one per time (the speed of a motor whose angle nobody models), else its `content`. A conjugate that is no
/// state is its `rate` if its unit is, or if the equations make it the rate of another quantity, its `displacement` and `level`.
/// `displacement` is also each input of its unit, where the effect allows that (Role::input_too). `to_port` is each other such port,
/// `other` each other state of the level's unit, and each input of it where the effect allows that. `factor` is each state among `rate` and
/// `level`. `other_signal` is each other output of the output's unit (with `other_output`: each pair once). `input` is each input, beside a
/// factor that is a state of a small system also each other state (a product once), and `output` each output (`signal` follows it), if the
/// system has a default for `input`, or for `signal`: its way of saying that generic effects make sense there. `parameter` is each free
/// parameter of a small system that is a port, `with` each state and input with which it is_more_than_a_force(), but none for those that
/// multiply one itself: their dependence on another along a line is a product of the two, bilinear. Where the effect allows that
/// (Role::parameter_too), `port` is also each such parameter, factors too unless it has a frequency. The time of all outputs
/// (`sample_time`) has a place only in a system with inputs: where nothing known has a clock, a motion at another time is as likely. Units
/// are looked at only where a role is never of one (Role::never): assemble() refuses what does not suit.
[[nodiscard]] std::vector<Roles> enumerate_bindings(const EffectSpec& effect, const SystemSpec& system);

/// Ports of the parameters of a small system that are free unless a study says otherwise; with `factors` too those that act in one equation
/// through one state or input alone (PortSpec::multiplies).
[[nodiscard]] std::vector<std::string> ports_of_parameters(const SystemSpec& system, bool factors);

/// A change of the parameter with this quantity is no force of one quantity: what changes a factor of v with v, or a constant force with
/// anything, is one.
[[nodiscard]] bool is_more_than_a_force(const PortSpec& parameter, const std::string& quantity);

}  // namespace misfit
