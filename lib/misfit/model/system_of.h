#pragma once

// How a system is written: a struct with its formulas once, as models/parachute/parachute_spherical.cpp.

#include <array>
#include <memory>
#include <utility>

#include "misfit/math/scalar.h"
#include "misfit/model/limits.h"
#include "misfit/model/registry.h"

// Left to itself, g++ calls a function for every sum of two Jets: a third of the time of a filter pass. Under the sanitizers a flattened
// formula takes minutes to compile.
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__clang__)
#define MISFIT_FLATTEN [[gnu::flatten]]
#else
#define MISFIT_FLATTEN
#endif

namespace misfit::formula {
/// As of a Jet (math/scalar.h).
inline bool vanishes(const Symbol& a) { return a == 0.0; }
}  // namespace misfit::formula

namespace misfit {

/// Turns a struct with templated formulas into a System. `S` has static NX, NU, NP (quantity ports), NF (dynamic ports), NQ, NK, NY and
///   template <class T, class K> void quantities(const PointOf<T, K>& at, uint64_t needed, T* q) const
///   template <class T, class K> void rates(const PointOf<T, K>& at, const T* F, T* dx) const
///   template <class T, class K> void outputs(const PointOf<T, K>& at, T* y) const   (of x, u, t and k; P is null there)
///   SystemSpec spec() const;   std::vector<DerivedCurve> derived_curves(const double* k) const
/// A system whose formulas take inputs and time as a third type, template <class T, class K, class U> … (const PointOf<T, K, U>& at, …),
/// is called with symbols, too, so that it can be exported; `bool traceable() const` may refuse that for some options. All first
/// derivatives come from Jets as wide as what varies: states alone in the common case.
template <class S>
class SystemOf final : public System {
 public:
  static_assert(S::NX <= kMaxStates && S::NU <= kMaxInputs && S::NQ <= kMaxQuantities && S::NK <= kMaxConstants && S::NY <= kMaxOutputs &&
                    S::NP <= kMaxPorts && S::NF <= kMaxPorts,
                "the system is larger than model/limits.h allows: split it, or raise the limit there");
  static_assert(
      requires(const S& s, const double* k) {
        s.spec();
        s.derived_curves(k);
        S::flags();
      }, "the system's struct needs spec(), derived_curves(k) and static flags(), as in models/parachute/parachute_planar.cpp");

  explicit SystemOf(S system) : system_(std::move(system)), spec_(system_.spec()) {}

  [[nodiscard]] const SystemSpec& spec() const override { return spec_; }
  [[nodiscard]] std::vector<DerivedCurve> derived_curves(const double* k) const override { return system_.derived_curves(k); }

  void quantities(const Point& at, std::uint64_t needed, double* q) const override {
    system_.template quantities<double, double>(at, needed, q);
  }
  void linearise_quantities(const Point& at, std::uint64_t needed, double* q, const QuantityDerivatives& d) const override {
    if (d.k != nullptr) return differentiate_quantities<S::NX + S::NP + S::NK>(at, needed, q, d);
    if constexpr (S::NP > 0) {
      if (d.P != nullptr) return differentiate_quantities<S::NX + S::NP>(at, needed, q, d);
    }
    differentiate_quantities<S::NX>(at, needed, q, d);
  }
  void rates(const Point& at, const double* F, double* dx) const override { system_.template rates<double, double>(at, F, dx); }
  void linearise_rates(const Point& at, const double* F, double* dx, const RateDerivatives& d) const override {
    if (d.k != nullptr) return differentiate_rates<S::NX + S::NF + S::NP + S::NK>(at, F, dx, d);
    if constexpr (S::NP > 0) {
      if (d.P != nullptr) return differentiate_rates<S::NX + S::NF + S::NP>(at, F, dx, d);
    }
    differentiate_rates<S::NX + S::NF>(at, F, dx, d);
  }
  void outputs(const Point& at, double* y) const override { system_.template outputs<double, double>(at, y); }
  void linearise_outputs(const Point& at, double* y, const OutputDerivatives& d) const override {
    if (d.k != nullptr) {
      differentiate_outputs<S::NX + S::NK>(at, y, d);
    } else {
      differentiate_outputs<S::NX>(at, y, d);
    }
  }
  [[nodiscard]] bool traceable() const override {
    if constexpr (requires { system_.traceable(); }) return system_.traceable();
    return takes_symbols();
  }
  void trace_quantities(const SymbolPoint& at, formula::Symbol* q) const override {
    if constexpr (takes_symbols()) system_.template quantities<Symbol, Symbol>(at, ~std::uint64_t{0}, q);
  }
  void trace_rates(const SymbolPoint& at, const formula::Symbol* F, formula::Symbol* dx) const override {
    if constexpr (takes_symbols()) system_.template rates<Symbol, Symbol>(at, F, dx);
  }
  void trace_outputs(const SymbolPoint& at, formula::Symbol* y) const override {
    if constexpr (takes_symbols()) system_.template outputs<Symbol, Symbol>(at, y);
  }
  bool read_states(const double* y, const double* k, double* x) const override {
    if constexpr (requires { system_.read_states(y, k, x); }) return system_.read_states(y, k, x);
    return false;
  }

 private:
  using Symbol = formula::Symbol;
  static consteval bool takes_symbols() {
    return requires(const S& system, const SymbolPoint& at, const Symbol* in, Symbol* out) {
      system.template quantities<Symbol, Symbol>(at, std::uint64_t{0}, out);
      system.template rates<Symbol, Symbol>(at, in, out);
      system.template outputs<Symbol, Symbol>(at, out);
    };
  }

  template <class T>
  static void seed(T* jets, const double* values, int count, int first) {
    for (int i = 0; i < count; ++i) jets[i] = T(values[i], first + i);
  }
  template <class T>
  static void plain(T* jets, const double* values, int count) {
    for (int i = 0; i < count; ++i) jets[i] = T(values[i]);
  }
  template <class T>
  static void block(const T& jet, int first, int count, double* row) {
    for (int i = 0; i < count; ++i) row[i] = jet.v[first + i];
  }
  static constexpr std::size_t at_least_one(int n) { return n > 0 ? n : 1; }

  template <int W>
  MISFIT_FLATTEN void differentiate_quantities(const Point& at, std::uint64_t needed, double* q, const QuantityDerivatives& d) const {
    using T = Jet<W>;
    constexpr bool with_P = W >= S::NX + S::NP && S::NP > 0;
    constexpr bool with_k = W > S::NX + S::NP;
    std::array<T, at_least_one(S::NX)> x;
    seed(x.data(), at.x, S::NX, 0);
    std::array<T, at_least_one(S::NP)> ports;
    if constexpr (with_P) {
      seed(ports.data(), at.P, S::NP, S::NX);
    } else {
      plain(ports.data(), at.P, S::NP);
    }
    std::array<T, S::NQ> out;
    if constexpr (with_k) {
      std::array<T, at_least_one(S::NK)> k;
      seed(k.data(), at.k, S::NK, S::NX + S::NP);
      system_.template quantities<T, T>(PointOf<T, T>{x.data(), at.u, at.t, k.data(), ports.data()}, needed, out.data());
    } else {
      system_.template quantities<T, double>(PointOf<T, double>{x.data(), at.u, at.t, at.k, ports.data()}, needed, out.data());
    }
    for (int i = 0; i < S::NQ; ++i) {
      if (!is_needed(needed, i)) continue;
      const T& jet = out[i];
      q[i] = jet.a;
      block(jet, 0, S::NX, d.x + i * S::NX);
      if constexpr (with_P) {
        if (d.P != nullptr) block(jet, S::NX, S::NP, d.P + i * S::NP);
      }
      if constexpr (with_k) block(jet, S::NX + S::NP, S::NK, d.k + i * S::NK);
    }
  }

  template <int W>
  MISFIT_FLATTEN void differentiate_rates(const Point& at, const double* F, double* dx, const RateDerivatives& d) const {
    using T = Jet<W>;
    constexpr bool with_P = W >= S::NX + S::NF + S::NP && S::NP > 0;
    constexpr bool with_k = W > S::NX + S::NF + S::NP;
    std::array<T, at_least_one(S::NX)> x;
    seed(x.data(), at.x, S::NX, 0);
    std::array<T, at_least_one(S::NF)> forces;
    seed(forces.data(), F, S::NF, S::NX);
    std::array<T, at_least_one(S::NP)> ports;
    if constexpr (with_P) {
      seed(ports.data(), at.P, S::NP, S::NX + S::NF);
    } else {
      plain(ports.data(), at.P, S::NP);
    }
    std::array<T, at_least_one(S::NX)> out;
    if constexpr (with_k) {
      std::array<T, at_least_one(S::NK)> k;
      seed(k.data(), at.k, S::NK, S::NX + S::NF + S::NP);
      system_.template rates<T, T>(PointOf<T, T>{x.data(), at.u, at.t, k.data(), ports.data()}, forces.data(), out.data());
    } else {
      system_.template rates<T, double>(PointOf<T, double>{x.data(), at.u, at.t, at.k, ports.data()}, forces.data(), out.data());
    }
    for (int i = 0; i < S::NX; ++i) {
      const T& jet = out[i];
      dx[i] = jet.a;
      block(jet, 0, S::NX, d.x + i * S::NX);
      block(jet, S::NX, S::NF, d.F + i * S::NF);
      if constexpr (with_P) {
        if (d.P != nullptr) block(jet, S::NX + S::NF, S::NP, d.P + i * S::NP);
      }
      if constexpr (with_k) block(jet, S::NX + S::NF + S::NP, S::NK, d.k + i * S::NK);
    }
  }

  template <int W>
  MISFIT_FLATTEN void differentiate_outputs(const Point& at, double* y, const OutputDerivatives& d) const {
    using T = Jet<W>;
    std::array<T, at_least_one(S::NX)> x;
    seed(x.data(), at.x, S::NX, 0);
    std::array<T, S::NY> out;
    if constexpr (W > S::NX) {
      std::array<T, at_least_one(S::NK)> k;
      seed(k.data(), at.k, S::NK, S::NX);
      system_.template outputs<T, T>(PointOf<T, T>{x.data(), at.u, at.t, k.data()}, out.data());
    } else {
      system_.template outputs<T, double>(PointOf<T, double>{x.data(), at.u, at.t, at.k}, out.data());
    }
    for (int i = 0; i < S::NY; ++i) {
      const T& jet = out[i];
      y[i] = jet.a;
      block(jet, 0, S::NX, d.x + i * S::NX);
      if constexpr (W > S::NX) block(jet, S::NX, S::NK, d.k + i * S::NK);
    }
  }

  S system_;
  SystemSpec spec_;
};

}  // namespace misfit

/// The last line of a system's file: `Type::flags()` lists the options and `Type(const SystemOptions&)` makes it.
#define MISFIT_SYSTEM(key, Type)                                                                                                       \
  void misfit_register_##key(misfit::Registry& registry);                                                                              \
  void misfit_register_##key(misfit::Registry& registry) {                                                                             \
    registry.add(misfit::SystemType{#key, Type::flags(), [](const misfit::SystemOptions& options) -> std::unique_ptr<misfit::System> { \
                                      return std::make_unique<misfit::SystemOf<Type>>(Type(options));                                  \
                                    }});                                                                                               \
  }
