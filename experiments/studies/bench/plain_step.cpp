#include "experiments/studies/bench/plain_step.hpp"

#include "experiments/studies/bench/plain_loops.hpp"
#include "pbs/geometry/module.hpp"
#include "pbs/solver/residuals.hpp"

namespace experiments {
namespace {

template <typename Scalar>
PlainLoops<Scalar> native_loops()
{
    const pbs::Module& module = pbs::load_module("pbskin_native_plain");
    PlainLoops<Scalar> loops;
    if constexpr (std::is_same_v<Scalar, float>)
        module.function<decltype(pbskin_native_plain_f32)>("pbskin_native_plain_f32")(&loops);
    else
        module.function<decltype(pbskin_native_plain_f64)>("pbskin_native_plain_f64")(&loops);
    return loops;
}

template <typename Scalar>
struct PlainState {
    pbs::ConstraintSet<Scalar> constraints;
    std::vector<pbs::Vector3<Scalar>> start, q, p;
};

template <typename Scalar>
ProjectionVariant variant_of(const char* name, const BenchBody& body, pbs::ConstraintSet<Scalar> constraints)
{
    const PlainLoops<Scalar> loops = native_loops<Scalar>();
    const auto points = points_of<Scalar>(body.twisted);
    const auto state = std::make_shared<PlainState<Scalar>>(
        PlainState<Scalar>{std::move(constraints), points, points_of<Scalar>(body.bind_points), points});
    ProjectionVariant variant{name, precision_of<Scalar>};
    variant.loops = {[state] { state->p = state->start; },
                     [state, loops] { loops.bind(state->constraints, state->q, state->p); },
                     [state, loops] { loops.stretch(state->constraints, state->p); },
                     [state, loops] { loops.volume(state->constraints, state->p); },
                     [] {},
                     [state] { return pbs::residuals_of(state->constraints, state->p, state->q); }};
    return variant;
}

// Neighbours in the list come from eight far parts of the old one by turns.
template <typename Constraint>
std::vector<Constraint> spread(const std::vector<Constraint>& constraints)
{
    constexpr std::size_t parts = 8;
    std::vector<Constraint> result;
    const std::size_t a_part = (constraints.size() + parts - 1) / parts;
    for (std::size_t i = 0; i < a_part; ++i)
        for (std::size_t part = 0; part < parts; ++part)
            if (i + part * a_part < constraints.size()) result.push_back(constraints[i + part * a_part]);
    return result;
}

}  // namespace

pbs::PbsOptions bench_options(pbs::Order order, int threads)
{
    pbs::PbsOptions options;
    options.order = order;
    options.threads = threads;
    return options;
}

template <typename Scalar>
pbs::ConstraintSet<Scalar> bench_constraints(const BenchBody& body)
{
    return pbs::make_constraint_set<Scalar>(body.mesh(), body.character.binding.distance, {}, pbs::PbsOptions(), body.held);
}

template <typename Scalar>
std::vector<pbs::Vector3<Scalar>> points_of(const pbs::Positions& positions)
{
    std::vector<pbs::Vector3<Scalar>> points;
    for (Eigen::Index i = 0; i < positions.rows(); ++i) points.push_back(positions.row(i).transpose().template cast<Scalar>());
    return points;
}

template <typename Scalar>
ProjectionVariant native_plain(const BenchBody& body)
{
    return variant_of<Scalar>("plain_native", body, bench_constraints<Scalar>(body));
}

template <typename Scalar>
ProjectionVariant native_plain_spread(const BenchBody& body)
{
    pbs::ConstraintSet<Scalar> constraints = bench_constraints<Scalar>(body);
    constraints.stretch = spread(constraints.stretch);
    constraints.volume = spread(constraints.volume);
    return variant_of<Scalar>("plain_spread", body, std::move(constraints));
}

template pbs::ConstraintSet<float> bench_constraints(const BenchBody&);
template pbs::ConstraintSet<double> bench_constraints(const BenchBody&);
template std::vector<pbs::Vector3<float>> points_of(const pbs::Positions&);
template std::vector<pbs::Vector3<double>> points_of(const pbs::Positions&);
template ProjectionVariant native_plain<float>(const BenchBody&);
template ProjectionVariant native_plain<double>(const BenchBody&);
template ProjectionVariant native_plain_spread<float>(const BenchBody&);
template ProjectionVariant native_plain_spread<double>(const BenchBody&);

}  // namespace experiments
