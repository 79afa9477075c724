#include "experiments/studies/bench/step_loops.hpp"

#include "experiments/studies/bench/plain_loops.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "pbs/geometry/module.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/batched/pose_projection.hpp"
#include "pbs/solver/step_summary.hpp"

#include <algorithm>
#include <thread>
#include <type_traits>

namespace experiments {
namespace {

template <typename Scalar>
constexpr const char* precision_of = std::is_same_v<Scalar, float> ? "f32" : "f64";

// The stiffnesses are the scenes' defaults.
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
    for (const auto& row : positions.rowwise()) points.push_back(row.transpose().template cast<Scalar>());
    return points;
}

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
ProjectionVariant of_native_loops(const BenchBody& body, const char* name, pbs::ConstraintSet<Scalar> constraints)
{
    struct State {
        pbs::ConstraintSet<Scalar> constraints;
        std::vector<pbs::Vector3<Scalar>> initial, q, p;
    };
    const PlainLoops<Scalar> loops = native_loops<Scalar>();
    const auto points = points_of<Scalar>(body.twisted);
    const auto state = std::make_shared<State>(State{std::move(constraints), points, points_of<Scalar>(body.bind_points), points});
    ProjectionVariant variant{{name, precision_of<Scalar>}};
    variant.loops = {[state] { state->p = state->initial; },
                     [state, loops] { loops.bind(state->constraints, state->q, state->p); },
                     [state, loops] { loops.stretch(state->constraints, state->p); },
                     [state, loops] { loops.volume(state->constraints, state->p); },
                     [] {},
                     [state] { return pbs::residuals_of(state->constraints, state->p, state->q); }};
    return variant;
}

template <typename Scalar>
ProjectionVariant of_order(const BenchBody& body, const char* name, pbs::Order order, int threads)
{
    const pbs::PbsOptions options = bench_options(order, threads);
    const std::shared_ptr<pbs::Projection<Scalar>> projection =
        pbs::make_projection(bench_constraints<Scalar>(body), body.mesh().tets, options);
    ProjectionVariant variant{{name, precision_of<Scalar>, threads}};
    variant.loops = {[projection, &body] { projection->load(body.twisted, body.bind_points, pbs::Vec3::Zero()); },
                     [projection] { projection->project_bind_constraints(); },
                     [projection] { projection->project_stretch_constraints(); },
                     [projection] { projection->project_volume_constraints(); },
                     [projection, positions = body.twisted]() mutable { projection->store(pbs::Vec3::Zero(), positions); },
                     [projection] { return projection->residuals(); }};
    if (const auto* batched = dynamic_cast<const pbs::BatchedProjection<Scalar>*>(projection.get())) {
        variant.stretch_fill = batched->stretch_fill();
        variant.volume_fill = batched->volume_fill();
    }
    return variant;
}

// A block has sixteen poses, and each thread has one block. Threads beyond the machine's have none, since blocks cost memory.
int pose_blocks(int threads)
{
    return std::min(threads, std::max(2, static_cast<int>(std::thread::hardware_concurrency())));
}

template <typename Scalar>
struct PoseBlocks {
    PoseBlocks(const BenchBody& body, int threads)
        : program(pbs::make_pose_program(bench_constraints<Scalar>(body), body.mesh().tets, {}, pbs::Order::ordered)),
          parallel(threads),
          posed(body.twisted)
    {
        const std::vector<pbs::PbsOptions> poses(pbs::poses_a_block, bench_options(pbs::Order::ordered, 1));
        for (int block = 0; block < pose_blocks(threads); ++block) blocks.emplace_back(program, poses);
    }
    PoseBlocks(const PoseBlocks&) = delete;  // blocks point to the program

    template <typename Work>
    void on_all(const Work& work)
    {
        parallel.for_each(static_cast<int>(blocks.size()), [&](int block) { work(blocks[block]); });
    }

    pbs::PoseProgram<Scalar> program;
    pbs::Parallel parallel;
    std::vector<pbs::PoseBlock<Scalar>> blocks;
    pbs::Positions posed;
};

template <typename Scalar>
ProjectionVariant of_poses(const BenchBody& body, int threads)
{
    using Block = pbs::PoseBlock<Scalar>;
    const auto all = std::make_shared<PoseBlocks<Scalar>>(body, threads);
    const auto load = [&body](Block& block) {
        for (int lane = 0; lane < pbs::poses_a_block; ++lane) block.load(lane, body.twisted, body.bind_points, pbs::Vec3::Zero());
    };
    const auto store = [all] {
        for (const Block& block : all->blocks)
            for (int lane = 0; lane < pbs::poses_a_block; ++lane) block.store(lane, pbs::Vec3::Zero(), all->posed);
    };
    ProjectionVariant variant{{"poses", precision_of<Scalar>, threads}, pose_blocks(threads) * pbs::poses_a_block};
    variant.loops = {[all, load] { all->on_all(load); },
                     [all] { all->on_all([](Block& block) { block.project_bind_constraints(); }); },
                     [all] { all->on_all([](Block& block) { block.project_stretch_constraints(); }); },
                     [all] { all->on_all([](Block& block) { block.project_volume_constraints(); }); },
                     store,
                     [all, store, &body] {
                         store();
                         return pbs::residuals_of(bench_constraints<Scalar>(body), points_of<Scalar>(all->posed),
                                                  points_of<Scalar>(body.bind_points));
                     }};
    return variant;
}

template <typename Scalar>
void append(const BenchBody& body, const std::vector<int>& threads, std::vector<ProjectionVariant>& variants)
{
    variants.push_back(of_order<Scalar>(body, "plain", pbs::Order::plain, 1));
    pbs::ConstraintSet<Scalar> constraints = bench_constraints<Scalar>(body);
    variants.push_back(of_native_loops<Scalar>(body, "plain_native", constraints));
    in_spread_sequence(constraints);
    variants.push_back(of_native_loops<Scalar>(body, "plain_spread", std::move(constraints)));
    for (const int count : threads) {
        variants.push_back(of_order<Scalar>(body, "ordered", pbs::Order::ordered, count));
        variants.push_back(of_order<Scalar>(body, "grouped", pbs::Order::grouped, count));
        variants.push_back(of_poses<Scalar>(body, count));
    }
}

}  // namespace

std::vector<ProjectionVariant> projection_variants(const BenchBody& body, const std::vector<int>& threads)
{
    std::vector<ProjectionVariant> variants;
    append<float>(body, threads, variants);
    append<double>(body, threads, variants);
    return variants;
}

}  // namespace experiments
