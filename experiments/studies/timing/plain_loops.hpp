// The loops of order `plain` in two builds of the same source. The library's own build gives the same bits on every
// machine (no -march=native, no fused multiply-add). The module pbskin_native_plain is compiled for this machine
// (PBS_NATIVE), as by a user who compiles the paper's loops with all that the compiler offers. It is a module because
// inline functions of the two builds must not mix.
#pragma once

#include "pbs/solver/constraint_set.hpp"

#include <vector>

namespace experiments {

template <typename Scalar>
struct PlainLoops {
    using Points = std::vector<pbs::Vector3<Scalar>>;
    void (*bind)(const pbs::ConstraintSet<Scalar>& constraints, const Points& q, Points& p);
    void (*stretch)(const pbs::ConstraintSet<Scalar>& constraints, Points& p);
    void (*volume)(const pbs::ConstraintSet<Scalar>& constraints, Points& p);
};

}  // namespace experiments

extern "C" {
void pbskin_native_plain_f32(experiments::PlainLoops<float>* loops);
void pbskin_native_plain_f64(experiments::PlainLoops<double>* loops);
}
