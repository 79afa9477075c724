// The bodies of the bench, and the times of a step of projections on them.
#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/deformer_options.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/timing/bench.hpp"
#include "experiments/studies/timing/plain_loops.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/batched/pose_projection.hpp"
#include "pbs/solver/particles.hpp"
#include "pbs/solver/step_summary.hpp"
#include "pbs/system/module.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>
#include <tuple>
#include <type_traits>

namespace experiments {
namespace {

constexpr int most_meshed_tets = 150'000, smallest_bar = 200;  // vertices, of mesh_bar
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

// The bar's meshes have 6.0 V - 21.5 V^(2/3) tets, to within 5 % from 600 to 100,000: there are fewer at the skin,
// whose share falls with the size.
int vertices_for_tets(int tets)
{
    double vertices = tets / 6.0;
    for (int i = 0; i < 30; ++i) vertices = (tets + 21.5 * std::cbrt(vertices * vertices)) / 6.0;
    return std::max(smallest_bar, static_cast<int>(vertices));
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

template <typename Scalar>
std::vector<pbs::Vector3<Scalar>> points_of(const pbs::Positions& positions)
{
    std::vector<pbs::Vector3<Scalar>> points;
    for (const auto& row : positions.rowwise()) points.push_back(row.transpose().template cast<Scalar>());
    return points;
}

// Its particles keep their layout, so that there is nothing to store.
template <typename Scalar>
StepLoops native_loops(const std::string& precision, const pbs::ConstraintSet<Scalar>& constraints,
                       const StepStart& start)
{
    struct State {
        pbs::ConstraintSet<Scalar> constraints;
        std::vector<pbs::Vector3<Scalar>> initial, q, p;
        pbs::Positions nothing;
    };
    PlainLoops<Scalar> loops;
    const std::string name = "pbskin_native_plain_" + precision;
    pbs::load_module("pbskin_native_plain").function<void(PlainLoops<Scalar>*)>(name.c_str())(&loops);
    const auto points = points_of<Scalar>(start.guess);
    const auto state =
        std::make_shared<State>(State{constraints, points, points_of<Scalar>(start.bind_points), points, {}});
    return {[state] { state->p = state->initial; },
            [state, loops] { loops.bind(state->constraints, state->q, state->p); },
            [state, loops] { loops.stretch(state->constraints, state->p); },
            [state, loops] { loops.volume(state->constraints, state->p); },
            [state]() -> const pbs::Positions& { return state->nothing; },
            [state] { return pbs::residuals_of(state->constraints, state->p, state->q); }};
}

// A block has sixteen poses, and each thread has one block. Threads beyond the machine's have none, since blocks cost
// memory.
int pose_blocks(int threads)
{
    return std::min(threads, std::max(2, static_cast<int>(std::thread::hardware_concurrency())));
}

template <typename Scalar>
void append(const BenchBody& body, const std::vector<int>& threads, std::vector<ProjectionVariant>& variants)
{
    const std::string precision = std::is_same_v<Scalar, float> ? "f32" : "f64";
    const StepStart start{body.twisted, body.bind_points, false};
    const pbs::Tets& tets = body.mesh().tets;
    pbs::PbsOptions options;  // the stiffnesses are the scenes' defaults
    const auto constraints =
        pbs::make_constraint_set<Scalar>(body.mesh(), body.character.binding.distance, {}, options, body.held);
    const auto append_order = [&](pbs::Order order, int count) {
        options.order = order;
        options.threads = count;
        variants.push_back({name_of(order), precision, count, 1, step_loops(constraints, tets, options, start)});
    };
    append_order(pbs::Order::plain, 1);
    variants.push_back({"plain_native", precision, 1, 1, native_loops(precision, constraints, start)});
    variants.push_back({"plain_spread", precision, 1, 1, native_loops(precision, in_spread_order(constraints), start)});
    for (const int count : threads) {
        append_order(pbs::Order::ordered, count);
        variants.push_back({"poses", precision, count, pose_blocks(count) * pbs::poses_a_block,
                            loops_of_poses(constraints, tets, pbs::PbsOptions(), start, count)});
    }
}

// The values of one timed step [s], in this order.
enum Sample { stretch_laps_s, volume_laps_s, bind_laps_s, step_s, step_wall_s, transfer_s, samples };

double wall_s()
{
    static const pbs::Stopwatch since_start;
    return since_start.seconds();
}

// Adds the laps of a step to the sum of their class. Short steps are lapped by wall time, which takes some 25 ns to
// read. Long steps, in which other work is sure to get its turns, are lapped by processor time, which takes some ten
// times longer to read.
void project_step(const StepLoops& loops, double (*lap_clock)(), std::vector<double>& seconds)
{
    double before = lap_clock();
    const auto lap = [&](Sample sample) {
        const double now = lap_clock();
        seconds[sample] += now - before;
        before = now;
    };
    for (int iteration = 0; iteration < paper_iterations; ++iteration) {
        loops.bind();
        lap(bind_laps_s);
        loops.stretch();
        lap(stretch_laps_s);
        loops.volume();
        lap(volume_laps_s);
    }
}

std::vector<double> time_step(const ProjectionVariant& variant)
{
    constexpr double long_step_s = 2e-3;
    const StepLoops& loops = variant.loops;
    loops.load();
    const double warm_up = wall_s();  // brings the data into the caches after another variant's turn
    loops.iterate();
    const bool by_cpu = variant.threads == 1 && (wall_s() - warm_up) * paper_iterations > long_step_s;

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
    for (const Sample sample : {stretch_laps_s, volume_laps_s, bind_laps_s}) seconds[sample] *= seconds[step_s] / laps;
    return seconds;
}

nlohmann::json entry_of(const ProjectionVariant& variant, const Samples& own, const pbs::BodySize& size,
                        const std::vector<MemoryBandwidth>& memory)
{
    const pbs::ProjectionLayout layout{variant.scalar_bytes(), variant.poses};
    const double working_set_bytes = pbs::working_set_bytes(layout, size);
    const pbs::Residuals residuals = variant.loops.residuals();
    nlohmann::json entry = {{"variant", variant.variant},
                            {"precision", variant.precision},
                            {"threads", variant.threads},
                            {"poses", variant.poses},
                            {"clock", variant.threads == 1 ? "thread_cpu" : "wall"},
                            {"working_set_bytes", working_set_bytes},
                            {"ms_transfer", scaled(spread_of(own[transfer_s]), 1e3 / variant.poses).median},
                            {"residuals",
                             {{"stretch_rms", residuals.stretch_rms},
                              {"volume_rms", residuals.volume_rms},
                              {"bind_rms_m", residuals.bind_rms_m}}}};
    using enum pbs::ConstraintClass;
    for (const auto& [name, of, sample] :
         {std::tuple("ns_stretch", stretch, stretch_laps_s), std::tuple("ns_volume", volume, volume_laps_s),
          std::tuple("ns_bind", bind, bind_laps_s)})
        put_spread(entry, name,
                   scaled(spread_of(own[sample]), 1e9 / (paper_iterations * variant.poses * size.constraints(of))));
    put_spread(entry, "ms_step", scaled(spread_of(own[step_s]), 1e3 / variant.poses));
    const double step_bytes = paper_iterations * pbs::bytes_per_iteration(layout, size) / variant.poses;
    if (variant.threads == 1) entry["ms_floor"] = 1e-6 * step_bytes / bandwidth_at(memory, working_set_bytes);
    if (variant.loops.stretch_fill)
        entry["fill"] = {{"stretch", *variant.loops.stretch_fill}, {"volume", *variant.loops.volume_fill}};
    return entry;
}

double combined(const pbs::Residuals& residuals, double mean_distance_m)
{
    const double bind = residuals.bind_rms_m / mean_distance_m;
    return std::sqrt(
        (residuals.stretch_rms * residuals.stretch_rms + residuals.volume_rms * residuals.volume_rms + bind * bind) /
        3.0);
}

}  // namespace

pbs::Character skinned_along(const std::string& name, pbs::TetMesh mesh, pbs::Skeleton skeleton)
{
    pbs::Character character;
    character.name = name;
    character.skeleton = std::move(skeleton);
    character.binding = pbs::bind_to_nearest_bone(mesh.rest, character.skeleton);
    character.weights = pbs::paper_weights(character.binding, character.skeleton);
    for (int i = 0; i < character.weights.vertices(); ++i) character.blended.push_back(character.weights.blended(i));
    character.mesh = std::move(mesh);
    return character;
}

BenchBody make_bench_body(const std::string& name, pbs::TetMesh mesh)
{
    const Axis axis = longest_axis(mesh.rest);
    const pbs::Vec3 middle = (axis.begin + axis.end) / 2.0;
    BenchBody body{
        skinned_along(name, std::move(mesh), {{{"upper", -1, axis.begin, middle}, {"forearm", 0, middle, axis.end}}})};
    const pbs::Positions& rest = body.mesh().rest;
    body.twisted = twisted(rest, axis);
    body.bind_points = body.character.binding.rest_point;
    for (Eigen::Index i = 0; i < rest.rows(); ++i)
        body.held.push_back(axis.share(rest.row(i).transpose()) < held_bar_share);
    body.pose =
        pbs::joint_sweep(body.character.skeleton, 1, (axis.end - axis.begin).normalized(), angle_deg, 2, 0.01).steps[1];
    body.edges = static_cast<int>(pbs::edges_of(body.mesh().tets).rows());
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

template <typename Scalar>
StepLoops loops_of_poses(const pbs::ConstraintSet<Scalar>& constraints, const pbs::Tets& tets,
                         const pbs::PbsOptions& options, const StepStart& start, int threads)
{
    using Block = pbs::PoseBlock<Scalar>;
    struct State {
        pbs::ConstraintSet<Scalar> constraints;
        pbs::PoseProgram<Scalar> program;
        pbs::Parallel parallel;
        std::vector<Block> blocks = {};
        pbs::Vec3 origin = pbs::Vec3::Zero();
        pbs::Positions posed = {};
    };
    const auto state = std::make_shared<State>(
        State{constraints, pbs::make_pose_program(constraints, tets, {}), pbs::Parallel(threads)});
    state->blocks.assign(pose_blocks(threads),
                         Block(state->program, std::vector<pbs::PbsOptions>(pbs::poses_a_block, options)));
    const auto on_all = [state](const auto& work) {
        return [state, work] {
            state->parallel.for_each(static_cast<int>(state->blocks.size()),
                                     [&](int block) { work(state->blocks[block]); });
        };
    };
    const auto store = [state, start]() -> const pbs::Positions& {
        state->posed.resize(start.guess.rows(), 3);
        for (const Block& block : state->blocks)
            for (int lane = 0; lane < pbs::poses_a_block; ++lane) block.store(lane, state->origin, state->posed);
        return state->posed;
    };
    const auto load_block = on_all([state, start](Block& block) {
        for (int lane = 0; lane < pbs::poses_a_block; ++lane)
            block.load(lane, start.guess, start.bind_points, state->origin);
    });
    return {[state, start, load_block] {
                if (start.has_local_origin) state->origin = pbs::local_origin<Scalar>(start.guess);
                load_block();
            },
            on_all([](Block& block) { block.project_bind_constraints(); }),
            on_all([](Block& block) { block.project_stretch_constraints(); }),
            on_all([](Block& block) { block.project_volume_constraints(); }),
            store,
            [state, store, start] {
                return pbs::residuals_of(state->constraints, points_of<Scalar>(store()),
                                         points_of<Scalar>(start.bind_points));
            }};
}

template StepLoops loops_of_poses(const pbs::ConstraintSet<float>&, const pbs::Tets&, const pbs::PbsOptions&,
                                  const StepStart&, int);
template StepLoops loops_of_poses(const pbs::ConstraintSet<double>&, const pbs::Tets&, const pbs::PbsOptions&,
                                  const StepStart&, int);

std::vector<ProjectionVariant> projection_variants(const BenchBody& body, const std::vector<int>& threads)
{
    std::vector<ProjectionVariant> variants;
    append<float>(body, threads, variants);
    append<double>(body, threads, variants);
    return variants;
}

AnswerRatio answer_ratio(const pbs::Residuals& own, const pbs::Residuals& plain, double mean_distance_m)
{
    return {combined(own, mean_distance_m) / combined(plain, mean_distance_m), own.volume_rms / plain.volume_rms};
}

nlohmann::json time_projections(const BenchBody& body, const std::vector<int>& threads,
                                const std::vector<MemoryBandwidth>& memory, const Rounds& rounds)
{
    const std::vector<ProjectionVariant> variants = projection_variants(body, threads);
    std::vector<TimedVariant> turns;
    for (const ProjectionVariant& variant : variants) turns.push_back([&variant] { return time_step(variant); });
    const std::vector<Samples> samples_of_variants = take_turns(turns, rounds);
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
        nlohmann::json entry = entry_of(variant, samples_of_variants[i], size, memory);
        const Sample clock = variant.threads == 1 ? step_s : step_wall_s;
        for (const std::string baseline : {"plain_spread", "plain", "plain_native"}) {
            const std::size_t place = place_of(baseline, variant.precision);
            put_spread(
                entry, "ratio_to_" + baseline,
                spread_of_ratios(samples_of_variants.at(place)[clock], samples_of_variants[i][clock], variant.poses));
            if (baseline == "plain_native") continue;  // the same answer as plain
            const AnswerRatio answer =
                answer_ratio(variant.loops.residuals(), variants[place].loops.residuals(), mean_distance_m);
            entry["residual_to_" + baseline] = answer.residual;
            entry["volume_rms_to_" + baseline] = answer.volume_rms;
        }
        if (variant.threads > 1) {
            const std::size_t alone = place_of(variant.variant, variant.precision);
            const std::vector<double>&alone_s = samples_of_variants.at(alone)[step_wall_s],
                  &together_s = samples_of_variants[i][step_wall_s];
            const double times_the_poses = double(variant.poses) / variants[alone].poses;
            put_spread(entry, "speedup_by_threads", spread_of_ratios(alone_s, together_s, times_the_poses));
            // Of the fastest rounds, which were disturbed least.
            entry["best_speedup_by_threads"] =
                times_the_poses * std::ranges::min(alone_s) / std::ranges::min(together_s);
        }
        entries.push_back(std::move(entry));
    }
    return entries;
}

}  // namespace experiments
