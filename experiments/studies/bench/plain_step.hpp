// The yardsticks plain_native and plain_spread (step_loops.hpp), and what all variants are made of: stiffnesses are the scenes' defaults.
#pragma once

#include "experiments/studies/bench/step_loops.hpp"
#include "pbs/solver/constraint_set.hpp"

#include <type_traits>
#include <vector>

namespace experiments {

template <typename Scalar>
inline constexpr const char* precision_of = std::is_same_v<Scalar, float> ? "f32" : "f64";

pbs::PbsOptions bench_options(pbs::Order order, int threads);

template <typename Scalar>
pbs::ConstraintSet<Scalar> bench_constraints(const BenchBody& body);

template <typename Scalar>
std::vector<pbs::Vector3<Scalar>> points_of(const pbs::Positions& positions);

template <typename Scalar>
ProjectionVariant native_plain(const BenchBody& body);
template <typename Scalar>
ProjectionVariant native_plain_spread(const BenchBody& body);

}  // namespace experiments
