#pragma once

// One description of a struct's fields for JSON in both directions. For .cpp files of this layer and above; no public header includes it.
//
//   template <class Archive>
//   void fields(Archive& json, MaybeConst<Candidate> auto& c) {
//     json("rank", c.rank);
//     json("predicted_drop", c.predicted_drop);
//   }
//
// JsonWriter writes the keys in the order of the calls. JsonReader demands each of them: what is missing or of another type is a
// nlohmann::json::exception, which read_json() turns into an InputError that names the file. JSON has no NaN: a number that is not finite
// is written as null; null is read as NaN, and as nullopt where the number is optional.

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "misfit/core/enum_name.h"
#include "misfit/core/error.h"
#include "misfit/core/fields.h"
#include "misfit/core/files.h"
#include "misfit/core/units.h"
#include "misfit/data/fit.h"

namespace misfit {

using Json = nlohmann::ordered_json;

[[nodiscard]] inline Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
[[nodiscard]] inline double number_from(const Json& json) {
  return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

// How a field is stored where that is not its own form. All refer to the field.

/// Stored times `factor`. See JsonWriter::factor().
template <class Number>
struct Scaled {
  Scaled(Number& value_, double factor_) : value(value_), factor(factor_) {}
  [[nodiscard]] Json stored() const { return json_number(value * factor); }
  void restore(const Json& json) const { value = number_from(json) * factor; }
  Number& value;
  double factor;
};

/// A sigma of 0 means "not estimated" and is stored as null: nobody must take it for certainty.
template <class Number>
struct Sigma {
  explicit Sigma(Number& value_, double factor_ = 1.0) : value(value_), factor(factor_) {}
  [[nodiscard]] Json stored() const { return value > 0.0 ? json_number(value * factor) : Json(nullptr); }
  void restore(const Json& json) const { value = json.is_null() ? 0.0 : json.get<double>() * factor; }
  Number& value;
  double factor;
};

/// An SI unit, stored as the one that people read: rad → deg.
template <class Text>
struct DisplayUnit {
  explicit DisplayUnit(Text& si_) : si(si_) {}
  [[nodiscard]] Json stored() const { return stored_unit(si); }
  void restore(const Json& json) const { si = si_unit(json.get<std::string>()); }
  Text& si;
};

/// An enumeration, stored as the name at its place in `names`. InputError for any other name.
template <class Enum, std::size_t N>
struct NameOf {
  NameOf(Enum& value_, const std::array<const char*, N>& names_) : value(value_), names(names_) {}
  [[nodiscard]] Json stored() const { return enum_name(names, value); }
  void restore(const Json& json) const {
    const std::string name = json.get<std::string>();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw InputError("'" + name + "' is not known" + suggest(name, {names.begin(), names.end()}));
    value = static_cast<Enum>(found - names.begin());
  }
  Enum& value;
  const std::array<const char*, N>& names;
};

/// The fields of a struct as `fields()` beside it has them.
inline constexpr auto own_fields = [](auto& json, auto& data) { fields(json, data); };

/// A struct, or every struct of a vector, map or optional, whose fields are described by form(json, data) instead.
template <class Data, class Form>
struct Formed {
  Formed(Data& data_, Form form_) : data(data_), form(form_) {}
  Data& data;
  Form form;
};

/// A vector of structs stored as {NAME: object, …}, the names being their members `name`.
template <class Structs, class Struct, class Form = decltype(own_fields)>
struct Named {
  Named(Structs& all_, std::string Struct::*name_, Form form_ = own_fields) : all(all_), name(name_), form(form_) {}
  Structs& all;
  std::string Struct::*name;
  Form form;
};

class JsonWriter {
 public:
  static constexpr bool reading = false;

  /// Any data: a number, a text, a struct with fields(), or vectors, maps, optionals, pairs and tuples of these.
  template <class Data>
  [[nodiscard]] static Json json_of(const Data& data) {
    return of(data, own_fields);
  }

  template <class Data>
  void operator()(const std::string& key, const Data& data) {
    object_[key] = of(data, own_fields);
  }
  /// Written only, never read: what follows from other fields.
  template <class Data>
  void derived(const std::string& key, const Data& data) {
    object_[key] = of(data, own_fields);
  }
  /// The key is left out where there is nothing.
  template <class Data>
  void if_there(const std::string& key, const std::optional<Data>& data) {
    if (data) object_[key] = of(*data, own_fields);
  }
  /// An object within, for fields of the struct itself: form(json).
  template <class Form>
  void group(const std::string& key, Form form) {
    JsonWriter within;
    form(within);
    object_[key] = std::move(within.object_);
  }
  /// For numbers of unit `si`, stored with the display unit under `key`: what Scaled and Sigma multiply with. Units that are not converted
  /// (dB) are none to the program either: 1.
  [[nodiscard]] double factor(const std::string& key, const std::string& si) const {
    static_cast<void>(key);
    return conversion(si, stored_unit(si));
  }

  [[nodiscard]] static double conversion(const std::string& from, const std::string& to) {
    return from == to ? 1.0 : convert(1.0, from, to);
  }

 private:
  template <class Data, class Form>
  static Json of(const Data& data, Form form) {
    if constexpr (std::is_floating_point_v<Data>) {
      return json_number(data);
    } else if constexpr (requires { data.stored(); }) {
      return data.stored();
    } else if constexpr (std::is_constructible_v<Json, Data> && !std::is_class_v<Data>) {
      return data;
    } else {
      JsonWriter within;
      form(within, data);
      return std::move(within.object_);
    }
  }
  template <class Form>
  static Json of(const Json& json, Form) {
    return json;
  }
  template <class Form>
  static Json of(const std::string& text, Form) {
    return text;
  }
  template <class Data, class Form>
  static Json of(const std::optional<Data>& data, Form form) {
    return data ? of(*data, form) : Json(nullptr);
  }
  template <class Data, class Form>
  static Json of(const std::vector<Data>& all, Form form) {
    Json out = Json::array();
    for (const auto& one : all) out.push_back(of(one, form));
    return out;
  }
  template <class Data, class Form>
  static Json of(const std::map<std::string, Data>& all, Form form) {
    Json out = Json::object();
    for (const auto& [name, one] : all) out[name] = of(one, form);
    return out;
  }
  template <class Data, class Form, class Outer>
  static Json of(const Formed<Data, Form>& formed, Outer) {
    return of(formed.data, formed.form);
  }
  template <class Structs, class Struct, class Form, class Outer>
  static Json of(const Named<Structs, Struct, Form>& named, Outer) {
    Json out = Json::object();
    for (const Struct& one : named.all) out[one.*named.name] = of(one, named.form);
    return out;
  }
  template <class A, class B, class Form>
  static Json of(const std::pair<A, B>& both, Form form) {
    return of(std::tie(both.first, both.second), form);
  }
  template <class... Data, class Form>
  static Json of(const std::tuple<Data...>& all, Form form) {
    Json out = Json::array();
    std::apply([&](const auto&... one) { (out.push_back(of(one, form)), ...); }, all);
    return out;
  }
  template <class Form>
  static Json of(const Eigen::MatrixXd& matrix, Form form) {
    Json out = Json::array();
    for (const auto& row : matrix.rowwise()) out.push_back(of(std::vector<double>(row.begin(), row.end()), form));
    return out;
  }

  Json object_ = Json::object();
};

class JsonReader {
 public:
  static constexpr bool reading = true;

  explicit JsonReader(const Json& object) : object_(object) {}

  template <class Data>
  static void read(const Json& json, Data& data) {
    into(json, data, own_fields);
  }

  template <class Data>
  void operator()(const std::string& key, Data&& data) const {
    into(object_.at(key), data, own_fields);
  }
  template <class Data>
  void derived(const std::string&, const Data&) const {}
  template <class Data>
  void if_there(const std::string& key, std::optional<Data>& data) const {
    data.reset();
    if (object_.contains(key)) into(object_.at(key), data.emplace(), own_fields);
  }
  template <class Form>
  void group(const std::string& key, Form form) const {
    JsonReader within(object_.at(key));
    form(within);
  }
  [[nodiscard]] double factor(const std::string& key, std::string& si) const {
    const std::string unit = object_.at(key);
    si = si_unit(unit);
    return JsonWriter::conversion(unit, si);
  }

 private:
  // Throw what is no array and what is no object.
  static const Json::array_t& elements(const Json& json) { return json.get_ref<const Json::array_t&>(); }
  static const Json::object_t& members(const Json& json) { return json.get_ref<const Json::object_t&>(); }

  template <class Data, class Form>
  static void into(const Json& json, Data& data, Form form) {
    if constexpr (std::is_floating_point_v<Data>) {
      data = number_from(json);
    } else if constexpr (requires { data.restore(json); }) {
      data.restore(json);
    } else if constexpr (std::is_arithmetic_v<Data> || std::is_same_v<Data, std::string>) {
      data = json.get<Data>();
    } else {
      JsonReader within(json);
      form(within, data);
    }
  }
  template <class Data, class Form>
  static void into(const Json& json, std::optional<Data>& data, Form form) {
    data.reset();
    if (!json.is_null()) into(json, data.emplace(), form);
  }
  template <class Data, class Form>
  static void into(const Json& json, std::vector<Data>& all, Form form) {
    all.clear();
    for (const Json& one : elements(json)) into(one, all.emplace_back(), form);
  }
  template <class Data, class Form>
  static void into(const Json& json, std::map<std::string, Data>& all, Form form) {
    all.clear();
    for (const auto& [name, one] : members(json)) into(one, all[name], form);
  }
  template <class Data, class Form, class Outer>
  static void into(const Json& json, Formed<Data, Form>& formed, Outer) {
    into(json, formed.data, formed.form);
  }
  template <class Structs, class Struct, class Form, class Outer>
  static void into(const Json& json, Named<Structs, Struct, Form>& named, Outer) {
    named.all.clear();
    for (const auto& [name, one] : members(json)) {
      named.all.emplace_back().*named.name = name;
      into(one, named.all.back(), named.form);
    }
  }
  template <class A, class B, class Form>
  static void into(const Json& json, std::pair<A, B>& both, Form form) {
    into(json, std::tie(both.first, both.second), form);
  }
  template <class... Data, class Form>
  static void into(const Json& json, std::tuple<Data...> all, Form form) {
    std::size_t k = 0;
    std::apply([&](auto&... one) { (into(json.at(k++), one, form), ...); }, all);
  }
  template <class Form>
  static void into(const Json& json, Eigen::MatrixXd& square, Form form) {
    std::vector<std::vector<double>> rows;
    into(json, rows, form);
    square.resize(std::ssize(rows), std::ssize(rows));
    Eigen::Index i = 0;
    for (const std::vector<double>& row : rows) {
      if (row.size() != rows.size())
        throw InputError(fmt::format("row {} of a covariance has {} entries, not {}", i + 1, row.size(), rows.size()));
      square.row(i++) = Eigen::Map<const Eigen::RowVectorXd>(row.data(), std::ssize(row));
    }
  }

  const Json& object_;
};

/// One element per line; bytes that are no UTF-8 are replaced. Atomic; RunError as write_atomically.
template <class Data>
void write_json(const std::filesystem::path& path, const Data& data) {
  write_atomically(path, JsonWriter::json_of(data).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

/// Whatever is wrong with the form of the file is an InputError that names it.
template <class Data>
[[nodiscard]] Data read_json(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  const auto wrong = [&](const std::exception& error) {
    return InputError(Source{path.string(), 0, 0}, std::string("not as misfit writes it: ") + error.what());
  };
  try {
    Data data;
    JsonReader::read(Json::parse(text), data);
    return data;
  } catch (const nlohmann::json::exception& error) {
    throw wrong(error);
  } catch (const InputError& error) {
    throw wrong(error);
  }
}

/// {"value","sigma","unit"}, and "interval": [low, high] (95 %) where it is not value ± 1.96 sigma.
template <class Archive>
void fields(Archive& json, MaybeConst<Estimate> auto& e) {
  json("value", e.value);
  json("sigma", Sigma(e.sigma));
  json("unit", e.unit);
  json.if_there("interval", e.interval);
}

/// {"value","sigma"} in degrees of an angle in radians.
template <class Archive>
void trim_fields(Archive& json, MaybeConst<Estimate> auto& trim) {
  double value = trim.value / kDegree, sigma = trim.sigma / kDegree;
  json("value", value);
  json("sigma", Sigma(sigma));
  if constexpr (Archive::reading) trim = {value * kDegree, sigma * kDegree, "rad"};
}

/// {"value","sigma","unit"} in the unit that people read.
inline constexpr auto display_fields = [](auto& json, auto& estimate) {
  const double factor = json.factor("unit", estimate.unit);
  json("value", Scaled(estimate.value, factor));
  json("sigma", Sigma(estimate.sigma, factor));
  json("unit", DisplayUnit(estimate.unit));
};

}  // namespace misfit
