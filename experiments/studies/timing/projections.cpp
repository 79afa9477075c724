// The bodies of the bench, and the times of a step of projections on them.
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "experiments/studies/timing/plain_loops.hpp"
#include "pbs/character/bodies.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/module.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/batched/pose_projection.hpp"
#include "pbs/solver/step_summary.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>
#include <tuple>
#include <type_traits>

namespace experiments {
namespace {

constexpr int most_meshed_tets = 150'000, smallest_bar = 150;  // 150 vertices
constexpr double held_bar_share = 0.025, angle_deg = 90.0;

struct Axis {
    pbs::Vec3 begin, end;  // through the middle of the bounding box, along its longest edge [m]

    double share(const pbs::Vec3& x) const { return (x - begin).dot(end - begin) / (end - begin).squaredNorm(); }
};

Axis longest_axis(const pbs::Positions& rest)
{
    const pbs::Vec3 lower = rest.colwise().minCoeff(), upper = rest.colwise().maxCoeff();
    int longest = 0;
    (upper - lower).maxCoeff(&longest);
    Axis axis{(lower + upper) / 2.0, (lower + upper) / 2.0};
    axis.begin(longest) = lower(longest);
    axis.end(longest) = upper(longest);
    return axis;
}

// The bar's meshes have 6.0 V - 21.5 V^(2/3) tets, to within 5 % from 600 to 100,000: there are fewer at the skin, whose share falls with
// the size.
int vertices_for_tets(int tets)
{
    double vertices = tets / 6.0;
    for (int i = 0; i < 30; ++i) vertices = (tets + 21.5 * std::cbrt(vertices * vertices)) / 6.0;
    return std::max(smallest_bar, static_cast<int>(vertices));
}

pbs::Skeleton two_bones(const Axis& axis)
{
    const pbs::Vec3 middle = (axis.begin + axis.end) / 2.0;
    return {{{"upper", -1, axis.begin, middle}, {"forearm", 0, middle, axis.end}}};
}

pbs::Positions twisted(const pbs::Positions& rest, const Axis& axis)
{
    const Eigen::AngleAxisd turn(angle_deg * std::numbers::pi / 180.0, (axis.end - axis.begin).normalized());
    pbs::Positions positions = rest;
    for (Eigen::Index i = 0; i < rest.rows(); ++i) {
        const pbs::Vec3 x = rest.row(i).transpose(), turned = axis.begin + turn * (x - axis.begin);
        positions.row(i) += axis.share(x) * (turned - x).transpose();
    }
    return positions;
}

}  // namespace

BenchBody make_bench_body(const std::string& name, pbs::TetMesh mesh)
{
    const Axis axis = longest_axis(mesh.rest);
    BenchBody body;
    body.character.name = name;
    body.character.skeleton = two_bones(axis);
    body.character.binding = pbs::bind_to_nearest_bone(mesh.rest, body.character.skeleton);
    body.character.weights = pbs::paper_weights(body.character.binding, body.character.skeleton);
    for (int i = 0; i < body.character.weights.vertices(); ++i) body.character.blended.push_back(body.character.weights.blended(i));
    body.twisted = twisted(mesh.rest, axis);
    body.bind_points = body.character.binding.rest_point;
    for (Eigen::Index i = 0; i < mesh.rest.rows(); ++i) body.held.push_back(axis.share(mesh.rest.row(i).transpose()) < held_bar_share);
    body.pose = pbs::joint_sweep(body.character.skeleton, 1, (axis.end - axis.begin).normalized(), angle_deg, 2, 0.01).steps[1];
    body.edges = static_cast<int>(pbs::edges_of(mesh.tets).rows());
    body.character.mesh = std::move(mesh);
    return body;
}

BenchBody bench_bar(int vertices)
{
    return make_bench_body("bar", pbs::make_character({.body = "bar", .vertices = vertices}).mesh);
}

BenchBody bench_bar_of_tets(int tets)
{
    if (tets <= most_meshed_tets) return bench_bar(vertices_for_tets(tets));
    const pbs::TetMesh coarse = pbs::make_character({.body = "bar", .vertices = vertices_for_tets(tets / 8)}).mesh;
    return make_bench_body("bar", pbs::refine(coarse).mesh);
}

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
    ProjectionVariant variant{name, precision_of<Scalar>};
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

namespace {

// The values of one timed step [s], in this order.
enum Sample { stretch_laps_s, volume_laps_s, bind_laps_s, step_s, step_wall_s, transfer_s, samples };

double wall_s()
{
    static const pbs::Stopwatch since_start;
    return since_start.seconds();
}

// Adds the laps of a step to the sum of their class. Short steps are lapped by wall time, which takes some 25 ns to read. Long steps, in
// which other work is sure to get its turns, are lapped by processor time, which takes some ten times longer to read.
void project_step(const StepLoops& loops, double (*lap_clock)(), std::vector<double>& seconds)
{
    double before = lap_clock();
    const auto lap = [&](Sample of) {
        const double now = lap_clock();
        seconds[of] += now - before;
        before = now;
    };
    for (int iteration = 0; iteration < iterations_per_step; ++iteration) {
        loops.bind(), lap(bind_laps_s);
        loops.stretch(), lap(stretch_laps_s);
        loops.volume(), lap(volume_laps_s);
    }
}

std::vector<double> time_step(const ProjectionVariant& variant)
{
    constexpr double long_step_s = 2e-3;
    const StepLoops& loops = variant.loops;
    loops.load();
    const double warm_up = wall_s();  // brings the data into the caches after another variant's turn
    loops.bind(), loops.stretch(), loops.volume();
    const bool by_cpu = variant.threads == 1 && (wall_s() - warm_up) * iterations_per_step > long_step_s;

    std::vector<double> seconds(samples, 0.0);
    const double load = wall_s();
    loops.load();
    const double cpu = thread_cpu_s(), wall = wall_s();
    project_step(loops, by_cpu ? thread_cpu_s : wall_s, seconds);
    const double cpu_end = thread_cpu_s(), wall_end = wall_s();
    loops.store();
    seconds[transfer_s] = wall - load + wall_s() - wall_end;
    seconds[step_wall_s] = wall_end - wall;
    seconds[step_s] = variant.threads == 1 ? cpu_end - cpu : wall_end - wall;
    const double laps = seconds[stretch_laps_s] + seconds[volume_laps_s] + seconds[bind_laps_s];
    for (const Sample of : {stretch_laps_s, volume_laps_s, bind_laps_s}) seconds[of] *= seconds[step_s] / laps;
    return seconds;
}

nlohmann::json entry_of(const ProjectionVariant& variant, const Samples& own, const pbs::BodySize& size,
                        const std::vector<MemoryBandwidth>& memory)
{
    const pbs::ProjectionLayout layout{variant.scalar_bytes(), variant.poses};
    const double working_set_bytes = pbs::working_set_bytes(layout, size);
    const pbs::Residuals residuals = variant.loops.residuals();
    nlohmann::json entry = {
        {"variant", variant.variant},
        {"precision", variant.precision},
        {"threads", variant.threads},
        {"poses", variant.poses},
        {"clock", variant.threads == 1 ? "thread_cpu" : "wall"},
        {"working_set_bytes", working_set_bytes},
        {"ms_transfer", scaled(spread_of(own[transfer_s]), 1e3 / variant.poses).median},
        {"residuals",
         {{"stretch_rms", residuals.stretch_rms}, {"volume_rms", residuals.volume_rms}, {"bind_rms_m", residuals.bind_rms_m}}}};
    using enum pbs::ConstraintClass;
    for (const auto& [name, of, sample] : {std::tuple("ns_stretch", stretch, stretch_laps_s),
                                           std::tuple("ns_volume", volume, volume_laps_s), std::tuple("ns_bind", bind, bind_laps_s)})
        put_spread(entry, name, scaled(spread_of(own[sample]), 1e9 / (iterations_per_step * variant.poses * size.constraints(of))));
    put_spread(entry, "ms_step", scaled(spread_of(own[step_s]), 1e3 / variant.poses));
    const double step_bytes = iterations_per_step * pbs::bytes_per_iteration(layout, size) / variant.poses;
    if (variant.threads == 1) entry["ms_floor"] = 1e-6 * step_bytes / bandwidth_at(memory, working_set_bytes);
    if (variant.stretch_fill) entry["fill"] = {{"stretch", *variant.stretch_fill}, {"volume", *variant.volume_fill}};
    return entry;
}

double combined(const pbs::Residuals& residuals, double mean_distance_m)
{
    const double bind = residuals.bind_rms_m / mean_distance_m;
    return std::sqrt((residuals.stretch_rms * residuals.stretch_rms + residuals.volume_rms * residuals.volume_rms + bind * bind) / 3.0);
}

}  // namespace

AnswerRatio answer_ratio(const pbs::Residuals& own, const pbs::Residuals& plain, double mean_distance_m)
{
    return {combined(own, mean_distance_m) / combined(plain, mean_distance_m), own.volume_rms / plain.volume_rms};
}

nlohmann::json time_projections(const BenchBody& body, const std::vector<int>& threads, const std::vector<MemoryBandwidth>& memory,
                                const Rounds& rounds)
{
    const std::vector<ProjectionVariant> variants = projection_variants(body, threads);
    std::vector<TimedVariant> turns;
    for (const ProjectionVariant& variant : variants) turns.push_back([&variant] { return time_step(variant); });
    const std::vector<Samples> all = take_turns(turns, rounds);
    // On one thread. std::out_of_range by at() where there is no such variant.
    const auto place_of = [&](const std::string& variant, const std::string& precision) {
        const auto found = std::ranges::find_if(variants, [&](const ProjectionVariant& one) {
            return one.variant == variant && one.precision == precision && one.threads == 1;
        });
        return static_cast<std::size_t>(found - variants.begin());
    };

    const pbs::BodySize size{double(body.mesh().rest.rows()), double(body.edges), double(body.mesh().tets.rows())};
    const double mean_distance_m = body.character.binding.distance.mean();
    nlohmann::json entries = nlohmann::json::array();
    for (std::size_t i = 0; i < variants.size(); ++i) {
        const ProjectionVariant& variant = variants[i];
        nlohmann::json entry = entry_of(variant, all[i], size, memory);
        const Sample clock = variant.threads == 1 ? step_s : step_wall_s;
        for (const std::string baseline : {"plain_spread", "plain", "plain_native"}) {
            const std::size_t place = place_of(baseline, variant.precision);
            put_spread(entry, "ratio_to_" + baseline, spread_of_ratios(all.at(place)[clock], all[i][clock], variant.poses));
            if (baseline == "plain_native") continue;  // the same answer as plain
            const AnswerRatio answer = answer_ratio(variant.loops.residuals(), variants[place].loops.residuals(), mean_distance_m);
            entry["residual_to_" + baseline] = answer.residual;
            entry["volume_rms_to_" + baseline] = answer.volume_rms;
        }
        if (variant.threads > 1) {
            const std::size_t alone = place_of(variant.variant, variant.precision);
            const std::vector<double>&alone_s = all.at(alone)[step_wall_s], &together_s = all[i][step_wall_s];
            const double times_the_poses = double(variant.poses) / variants[alone].poses;
            put_spread(entry, "speedup_by_threads", spread_of_ratios(alone_s, together_s, times_the_poses));
            // Of the fastest rounds, which were disturbed least.
            entry["best_speedup_by_threads"] = times_the_poses * std::ranges::min(alone_s) / std::ranges::min(together_s);
        }
        entries.push_back(std::move(entry));
    }
    return entries;
}

}  // namespace experiments
