#pragma once

#include <concepts>
#include <variant>

#include "core/internal_variables.hpp"
#include "materials/tensor.hpp"

namespace pliant {

/// Response of a law at one point (T: double), or at eight (Lanes).
template <class T>
struct Response {
  Tensor<T> P;  ///< first Piola stress, Pa
  T J;          ///< Jacobian, a by-product
  T power{};    ///< dissipated per reference volume, W/m3; of dissipative laws only
  T loss{};     ///< dissipated in the time increment per reference volume, J/m3; of laws that `has_loss`
};

/// A law is a struct of its constants, all of type T: of one material (double) or of eight in lanes. It has
///
///     Response<T> respond(F) const;            or respond(F, old, now) with internal variables
///                                              (core/internal_variables.hpp),
///                                              or respond(trial, F, rate, old, now) if it `has_rate`: rate = dF/dt,
///                                              1/s
///     T energy(F) const;                       stored per reference volume, J/m3; or energy(F, record)
///     double sigma_zz(F) const;                Cauchy stress out of the plane, Pa; or sigma_zz(F, record)
///     Law weighted(w) const;                   of w >= 0 times as much material: stresses, energies, powers times w
///                                              Padding points have w = 0: do not divide by such constants
///     LameConstants<T> small_strains() const;  instantaneous, before relaxation
///     static Law of(const Material&);          of one material
///
/// A law of the two Lame constants alone inherits the last three (LameLaw in elastic_constants.hpp). A law with
/// internal variables also has Law over(dt), the law for a time increment, s. A law as constructed, and over(0), hold
/// the internal variables: bounds, modes and energies are those of the elastic response from there on. Such a law says
/// by `has_loss` how it dissipates: true, a loss of its increments; false, a power at their ends, for the trapezoidal
/// rule. All laws with internal variables count as dissipative (`dissipates`).
///
/// A law whose response is a long chain of operations parts it in two, for the processor to do other work between:
///
///     Trial trial(F, old) const;               what follows from F before anything flows
///     Response<T> respond(trial, F, old, now) const;
///
/// Inlining is forced where calls would pass dozens of Lanes through memory.
template <class Law>
constexpr bool has_trial = requires { typename Law::Trial; };

/// Trial of a law that has one.
template <class Law, class T>
[[gnu::always_inline]] inline auto trial_of(const Law& law, const Tensor<T>& F, const Record<Law, T>& old) {
  if constexpr (has_trial<Law>)
    return law.trial(F, old);
  else
    return std::monostate{};
}

template <class Law, class Trial, class T>
[[gnu::always_inline]] inline Response<T> respond(const Law& law, const Trial& trial, const Tensor<T>& F,
                                                  const Tensor<T>& rate, const Record<Law, T>& old,
                                                  Record<Law, T>& now) {
  if constexpr (requires { law.respond(trial, F, rate, old, now); })
    return law.respond(trial, F, rate, old, now);
  else if constexpr (requires { law.respond(trial, F, old, now); })
    return law.respond(trial, F, old, now);
  else if constexpr (has_internal_variables<Law>)
    return law.respond(F, old, now);
  else
    return law.respond(F);
}
template <class Law, class T>
[[gnu::always_inline]] inline Response<T> respond(const Law& law, const Tensor<T>& F, const Tensor<T>& rate,
                                                  const Record<Law, T>& old, Record<Law, T>& now) {
  return respond(law, trial_of(law, F, old), F, rate, old, now);
}

/// Stored energy at F with internal variables held since `old`, J/m3.
template <class Law, class T>
T energy_of(const Law& law, const Tensor<T>& F, const Record<Law, T>& old) {
  if constexpr (has_internal_variables<Law>) {
    Record<Law, T> now;
    law.respond(F, old, now);
    return law.energy(F, now);
  } else {
    return law.energy(F);
  }
}

/// Cauchy stress out of the plane, Pa.
template <class Law>
double sigma_zz_of(const Law& law, const Tensor<double>& F, const Record<Law, double>& record) {
  if constexpr (requires { law.sigma_zz(F, record); })
    return law.sigma_zz(F, record);
  else
    return law.sigma_zz(F);
}

template <class Law>
Law over(const Law& law, double elapsed) {
  if constexpr (has_internal_variables<Law>)
    return law.over(elapsed);
  else
    return law;
}

template <class Law>
constexpr bool has_rate = requires { requires Law::has_rate; };
template <class Law>
constexpr bool has_loss = requires { requires Law::has_loss; };
/// Whether the law flows at constant volume, in which linear triangles lock.
template <class Law>
constexpr bool flow_keeps_volume = requires { requires Law::flow_keeps_volume; };
template <class Law>
constexpr bool dissipates = has_rate<Law> || has_internal_variables<Law>;

/// What a law of materials must state: with internal variables, how it responds to time and how it dissipates.
template <class Law>
concept CompleteMaterialLaw = !has_internal_variables<Law> || requires(const Law& law) {
  { law.over(1.0) } -> std::same_as<Law>;
  { Law::has_loss } -> std::convertible_to<bool>;
};

}  // namespace pliant
