#include "experiments/studies/timing/plain_loops.hpp"
#include "pbs/solver/project_plain.hpp"

namespace {

template <typename Scalar>
experiments::PlainLoops<Scalar> loops_of_this_build()
{
    return {&pbs::project_bind_constraints<Scalar>, &pbs::project_stretch_constraints<Scalar>,
            &pbs::project_volume_constraints<Scalar>};
}

}  // namespace

[[gnu::visibility("default")]] void pbskin_native_plain_f32(experiments::PlainLoops<float>* loops)
{
    *loops = loops_of_this_build<float>();
}

[[gnu::visibility("default")]] void pbskin_native_plain_f64(experiments::PlainLoops<double>* loops)
{
    *loops = loops_of_this_build<double>();
}
