#include "experiments/studies/bench/bench.hpp"

#include "experiments/deformers/fem/fem_options.hpp"
#include "experiments/deformers/registry.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <algorithm>
#include <functional>

namespace experiments {
namespace {

constexpr int most_fem_tets = 150'000;      // for the reference, whose first solve takes seconds there
constexpr int most_newton_tets = 12'000;    // for its nonlinear elements, of which a frame takes some twenty such solves
constexpr int most_deformer_tets = 30'000;  // for all deformers: the scalar ones take more than a tenth of a second per frame beyond
constexpr int further_frames = 5;           // per sample

constexpr double shortest_sample_s = 2e-4;  // several poses per sample, so that reading the clock does not count

struct BlendVariant {
    std::string blend, variant, precision;
    double scalar_bytes;
    std::function<void()> pose_once;
};

using PlainBlend = decltype(pbs::linear_blend_skinning);

BlendVariant plain_blend(const BenchBody& body, const char* name, PlainBlend* blend)
{
    const auto posed = std::make_shared<pbs::Positions>();
    return {name, "plain", "f64", 8.0, [&body, blend, posed] { blend(body.mesh().rest, body.character.weights, body.pose, *posed); }};
}

template <typename Scalar>
BlendVariant packed_blend(const BenchBody& body, const char* name,
                          void (pbs::BlendSkinning<Scalar>::*blend)(const pbs::Pose&, const pbs::Vec3&, Scalar*))
{
    const auto skinning = std::make_shared<pbs::BlendSkinning<Scalar>>(body.mesh().rest, body.character.weights);
    const auto posed = std::make_shared<std::vector<Scalar>>(body.mesh().rest.size());
    return {name, "packed", sizeof(Scalar) == 4 ? "f32" : "f64", double(sizeof(Scalar)),
            [&body, blend, skinning, posed] { ((*skinning).*blend)(body.pose, pbs::Vec3::Zero(), posed->data()); }};
}

std::vector<BlendVariant> blend_variants(const BenchBody& body)
{
    using Single = pbs::BlendSkinning<float>;
    using Double = pbs::BlendSkinning<double>;
    return {
        plain_blend(body, "lbs", &pbs::linear_blend_skinning),           packed_blend<float>(body, "lbs", &Single::linear_rows),
        packed_blend<double>(body, "lbs", &Double::linear_rows),         plain_blend(body, "dqs", &pbs::dual_quaternion_skinning),
        packed_blend<float>(body, "dqs", &Single::dual_quaternion_rows), packed_blend<double>(body, "dqs", &Double::dual_quaternion_rows)};
}

double seconds_per_pose(const BlendVariant& variant)
{
    variant.pose_once();
    int poses = 0;
    const double start = thread_cpu_s();
    double took = 0.0;
    for (int repeats = 1; took < shortest_sample_s; repeats *= 2) {
        for (int i = 0; i < repeats; ++i) variant.pose_once();
        poses += repeats;
        took = thread_cpu_s() - start;
    }
    return took / poses;
}

std::vector<SkinningTiming> time_skinning(const BenchBody& body, const MachineLimits& limits, const Rounds& rounds)
{
    const std::vector<BlendVariant> variants = blend_variants(body);
    std::vector<TimedVariant> turns;
    for (const BlendVariant& variant : variants) turns.push_back([&variant] { return std::vector<double>{seconds_per_pose(variant)}; });
    const std::vector<Samples> samples = take_turns(turns, rounds);

    std::vector<SkinningTiming> timings;
    std::size_t plain = 0;  // of the same blend, whose first variant it is
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const BlendVariant& variant = variants[i];
        if (variant.variant == "plain") plain = i;
        const double vertices = double(body.mesh().rest.rows()), bytes = 2.0 * 3.0 * variant.scalar_bytes * vertices;
        const Spread seconds = spread_of(samples[i][0]);
        const double gb_s = 1e-9 * bytes / seconds.median;
        timings.push_back({variant.blend, variant.variant, variant.precision, scaled(seconds, 1e9 / vertices),
                           spread_of_ratios(samples[plain][0], samples[i][0]), gb_s, gb_s / bandwidth_at(limits, bytes)});
    }
    return timings;
}

// First solve and one further frame [s].
std::vector<double> time_fem_frames(const DeformerSpec& spec, const BenchBody& body)
{
    const std::unique_ptr<Deformer> fem = make_deformer(spec);
    const pbs::Pose rest(body.pose.size(), Eigen::Isometry3d::Identity());
    const double first = cpu_seconds([&] {
        fem->reset(body.character);
        fem->advance(body.pose, 0.01);
    });
    const double further = cpu_seconds([&] {
        for (int frame = 0; frame < further_frames; ++frame) fem->advance(frame % 2 == 0 ? rest : body.pose, 0.01);
    });
    return {first, further / further_frames};
}

// pbs::InputError where the build has no reference, or a bone of the body cannot be gripped.
FemTiming time_fem(const BenchBody& body, const Rounds& rounds)
{
    DeformerSpec spec = default_spec("fem");
    options_of<FemOptions>(spec).element_order = 1;
    const auto samples = take_turns({[&] { return time_fem_frames(spec, body); }}, rounds);
    FemTiming timing{scaled(spread_of(samples[0][0]), 1e3), scaled(spread_of(samples[0][1]), 1e3)};
    timing.further_to_first = timing.ms_further_frame.median / timing.ms_first_solve.median;
    return timing;
}

}  // namespace

MeshTimings time_mesh(const BenchBody& body, const MachineLimits& limits, const MeshTimingOptions& options)
{
    MeshTimings timings;
    timings.name = body.character.name;
    timings.vertices = static_cast<int>(body.mesh().rest.rows());
    timings.edges = body.edges;
    timings.tets = static_cast<int>(body.mesh().tets.rows());
    timings.memory = peak_memory_of([&] {
        pbs::PbsSolver solver(body.mesh(), body.character.binding.distance, {}, {}, body.held);
        solver.advance(body.twisted, body.bind_points, 0.01);
    });
    timings.projections = time_projections(body, options.threads, limits, options.rounds);
    Rounds rounds = options.rounds;
    rounds.seconds /= 4.0;
    timings.skinning = time_skinning(body, limits, rounds);
    if (options.fem && timings.tets <= most_deformer_tets) {
        Rounds of_a_kind = rounds;
        of_a_kind.seconds /= 4.0;
        timings.deformers = time_deformers(body, of_a_kind);
    }
    if (!options.fem || timings.tets > most_fem_tets) return timings;
    rounds.fewest = std::min(rounds.fewest, 2);
    rounds.most = std::min(rounds.most, 11);
    try {
        timings.fem = time_fem(body, rounds);
        if (timings.tets <= most_newton_tets) timings.newton = time_newton(body, rounds);
    } catch (const pbs::InputError& error) {
        timings.fem_left_out = error.what();
    }
    return timings;
}

}  // namespace experiments
