// The loops of order `plain`, as two builds of the same source have them: the library's own, which gives the same bits on every machine
// (no -march=native, no fused multiply-add), and that of the module pbskin_native_plain, compiled for this one (PBS_NATIVE): what a user
// who compiles the paper's loops with all the compiler offers would have. A module, because inline functions of the two must not mix.
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
