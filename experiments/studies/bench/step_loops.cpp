#include "experiments/studies/bench/step_loops.hpp"

#include "experiments/studies/bench/plain_step.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/batched/pose_projection.hpp"
#include "pbs/solver/parallel.hpp"
#include "pbs/solver/residuals.hpp"

#include <algorithm>
#include <thread>

namespace experiments {
namespace {

template <typename Scalar>
ProjectionVariant of_order(const BenchBody& body, const char* name, pbs::Order order, int threads)
{
    const pbs::PbsOptions options = bench_options(order, threads);
    const std::shared_ptr<pbs::Projection<Scalar>> projection =
        pbs::make_projection(bench_constraints<Scalar>(body), body.mesh().tets, options);
    ProjectionVariant variant{name, precision_of<Scalar>, threads};
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

// Sixteen poses are a block, one for each thread; of more threads than the machine has none, for blocks cost memory.
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
    ProjectionVariant variant{"poses", precision_of<Scalar>, threads, pose_blocks(threads) * pbs::poses_a_block};
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
    variants.push_back(native_plain<Scalar>(body));
    variants.push_back(native_plain_spread<Scalar>(body));
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
