// SPDX-License-Identifier: MIT
#pragma once

#include <variant>

#include "compensation/methods/autopilot_methods.h"
#include "compensation/methods/bp_method.h"
#include "compensation/methods/curve_methods.h"
#include "compensation/methods/population_method.h"
#include "compensation/methods/radial_basis.h"
#include "compensation/methods/resonances.h"

namespace beamgyro::internal {

/// Every method of training (method.h). A new one is a unit of this room and a
/// line here.
using FitSpec = std::variant<NoneSpec, ConstantSpec, PolynomialSpec, TableSpec,
                             SplineSpec, Px4Spec, ArduPilotSpec, ThermistorSpec,
                             FuzzySpec, RadialBasisSpec, ResonancesSpec, BpSpec,
                             PopulationSpec, AdaptedSpec>;

namespace method_list {

template <class Kept, class... Methods>
struct FunctionsOf;

template <class... Kept>
struct FunctionsOf<std::variant<Kept...>> {
  using Type = std::variant<Kept...>;
};

template <class... Kept, class Method, class... Others>
struct FunctionsOf<std::variant<Kept...>, Method, Others...>
    : std::conditional_t<
          (std::is_same_v<Kept, typename Method::Function> || ...),
          FunctionsOf<std::variant<Kept...>, Others...>,
          FunctionsOf<std::variant<Kept..., typename Method::Function>,
                      Others...>> {};

template <class Methods>
struct AllFunctions;

template <class... Methods>
struct AllFunctions<std::variant<Methods...>>
    : FunctionsOf<std::variant<>, Methods...> {};

}  // namespace method_list

/// Every kind of bias function (bias_function.h) that a method gives.
using BiasFunction = method_list::AllFunctions<FitSpec>::Type;

/// Calls `use.template operator()<T>()` for each alternative T of a variant.
template <class... Alternatives, class Use>
void for_each_alternative(const std::variant<Alternatives...>*, Use&& use) {
  (use.template operator()<Alternatives>(), ...);
}
template <class Variant, class Use>
void for_each_alternative(Use&& use) {
  for_each_alternative(static_cast<const Variant*>(nullptr), use);
}

}  // namespace beamgyro::internal
