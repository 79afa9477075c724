#include "experiments/studies/stability/stability_cells.hpp"

#include "experiments/characters/bodies.hpp"
#include "experiments/deformers/registry.hpp"
#include "experiments/process/machine.hpp"
#include "experiments/scene/scene.hpp"
#include "experiments/studies/shared/iteration_path.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/particles.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/xpbd_solver.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

namespace experiments {
namespace {

constexpr int limb_vertices = 400;

pbs::Character spoilt(pbs::Character character, Defect defect, double thinness)
{
    character.mesh = distorted(character.mesh, defect, thinness);
    character.binding = pbs::bind_to_nearest_bone(character.mesh.rest, character.skeleton);
    character.weights = pbs::paper_weights(character.binding, character.skeleton);
    for (int vertex = 0; vertex < character.weights.vertices(); ++vertex)
        character.blended[vertex] = character.weights.blended(vertex);
    return character;
}

std::vector<pbs::Pose> way_of(const StabilityCell& cell, const pbs::Skeleton& skeleton)
{
    const Disturbance& disturbance = cell.disturbance;
    std::vector<pbs::Pose> way;
    if (!pbs::is_character(cell.body)) {
        const int forearm = pbs::find_bone(skeleton, "forearm");
        way = pbs::joint_sweep(skeleton, forearm, disturbance.axis, disturbance.angle_deg,
                               disturbance.turning_steps + 1, cell.time_step_s)
                  .steps;
    } else if (disturbance.angle_deg == 0.0) {
        way = {pbs::Pose(skeleton.bones.size(), Eigen::Isometry3d::Identity())};
    } else {
        const Scene scene = stability_scene(cell.body);
        way = make_motion(scene.motion, skeleton, scene.file).steps;
    }
    if (disturbance.teleport_m > 0.0) {
        way = {way.back(), way.back()};
        for (Eigen::Isometry3d& bone : way.back())
            bone.pretranslate(disturbance.teleport_m * pbs::Vec3::Ones().normalized());
    }
    if (disturbance.stays || disturbance.start != Start::none) way = {way.back()};
    return way;
}

pbs::Positions random_shape(const pbs::Positions& blended)
{
    std::mt19937 engine(stability_seed);
    const Eigen::RowVector3d lower = blended.colwise().minCoeff(), size = blended.colwise().maxCoeff() - lower;
    pbs::Positions shape(blended.rows(), 3);
    for (Eigen::Index i = 0; i < shape.size(); ++i)
        shape.data()[i] = lower(i % 3) + size(i % 3) * std::uniform_real_distribution<double>(0.0, 1.0)(engine);
    return shape;
}

// Scaled about the centre of the blended shape; flattened and mirrored in z.
pbs::Positions started(Start start, const pbs::Positions& blended)
{
    const Eigen::RowVector3d middle = blended.colwise().mean();
    const auto scaled = [&](double x, double y, double z) -> pbs::Positions {
        return ((blended.rowwise() - middle) * pbs::Vec3(x, y, z).asDiagonal()).rowwise() + middle;
    };
    switch (start) {
        case Start::flattened:
            return scaled(1.0, 1.0, 0.0);
        case Start::mirrored:
            return scaled(1.0, 1.0, -1.0);
        case Start::point:
            return scaled(0.0, 0.0, 0.0);
        case Start::random:
            return random_shape(blended);
        case Start::none:
            break;
    }
    return blended;
}

std::vector<bool> zone_of(const pbs::Character& character, bool jiggles)
{
    return jiggles ? pbs::jiggle_zone(character.binding) : std::vector<bool>{};
}

// The last tenth of the body along x.
std::vector<bool> end_of(const pbs::Character& character)
{
    const Eigen::VectorXd x = character.mesh.rest.col(0);
    const double limit = x.minCoeff() + 0.1 * (x.maxCoeff() - x.minCoeff());
    std::vector<bool> held;
    for (const double at : x) held.push_back(at < limit);
    return held;
}

template <typename Solver>
class Solved : public DrivenBody {
public:
    template <typename... Arguments>
    explicit Solved(const Arguments&... arguments) : solver_(arguments...)
    {
    }
    pbs::StepSummary advance(const Drive& drive, double dt_s) override
    {
        return solver_.advance(drive.blended, drive.bind_points, dt_s);
    }
    const pbs::Positions& positions() const override { return solver_.positions(); }

private:
    Solver solver_;
};

// Algorithm 1 with particles of unequal masses, which the paper's m_i = 1 excludes: seeded masses from 1 to `ratio`
// with logarithms that are uniformly distributed over the vertices.
class UnequalMasses : public DrivenBody {
public:
    UnequalMasses(const pbs::Character& character, const std::vector<bool>& jiggle_zone, const pbs::PbsOptions& options,
                  double ratio)
        : iterations_(options.iterations), particles_(character.mesh.rest, jiggle_zone, options)
    {
        const auto loops_in = [&](auto scalar) {
            using Scalar = decltype(scalar);
            auto constraints =
                pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, jiggle_zone, options);
            std::mt19937 engine(stability_seed);
            std::uniform_real_distribution<double> share(0.0, 1.0);
            for (Scalar& inverse_mass : constraints.inverse_mass)
                inverse_mass = static_cast<Scalar>(std::pow(ratio, -share(engine)));
            return step_loops(constraints, character.mesh.tets, options, {particles_.predicted(), bind_points_});
        };
        loops_ = options.precision == pbs::Precision::f32 ? loops_in(float()) : loops_in(double());
    }
    pbs::StepSummary advance(const Drive& drive, double dt_s) override
    {
        particles_.predict(drive.blended, dt_s);
        bind_points_ = drive.bind_points;
        loops_.load();
        for (int iteration = 0; iteration < iterations_; ++iteration) loops_.iterate();
        particles_.predicted() = loops_.store();
        particles_.update(dt_s);
        pbs::StepSummary summary;
        summary.iterations = iterations_;
        if (!particles_.positions().allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }
    const pbs::Positions& positions() const override { return particles_.positions(); }

private:
    int iterations_;
    pbs::Particles particles_;
    pbs::Positions bind_points_;  // [m], #V x 3
    StepLoops loops_;
};

// The deformers of the registry. They take only the pose and, where the initial state is broken, its shape.
class Posed : public DrivenBody {
public:
    Posed(const StabilityCell& cell, const pbs::Character& character)
        : deformer_(make_deformer(cell.spec)),
          is_to_start_(cell.disturbance.start != Start::none),
          nudge_m_(cell.nudge_m)
    {
        deformer_->reset(character);
    }
    pbs::StepSummary advance(const Drive& drive, double dt_s) override
    {
        if (is_to_start_) deformer_->start_from(drive.blended);
        is_to_start_ = false;
        is_nudged_ = !is_nudged_;
        if (nudge_m_ == 0.0 || !is_nudged_) return deformer_->advance(drive.pose, dt_s);
        pbs::Pose pose = drive.pose;
        for (Eigen::Isometry3d& bone : pose) bone.pretranslate(nudge_m_ * pbs::Vec3::UnitX());
        return deformer_->advance(pose, dt_s);
    }
    const pbs::Positions& positions() const override { return deformer_->positions(); }

private:
    std::unique_ptr<Deformer> deformer_;
    bool is_to_start_, is_nudged_ = false;
    double nudge_m_;
};

std::unique_ptr<DrivenBody> make_pbs(const StabilityCell& cell, const pbs::Character& character)
{
    const auto& options = options_of<pbs::PbsOptions>(cell.spec);
    std::vector<bool> zone = zone_of(character, options.jiggle.has_value());
    const pbs::TetMesh& mesh = character.mesh;
    const Eigen::VectorXd& distance = character.binding.distance;
    if (cell.mass_ratio > 1.0) return std::make_unique<UnequalMasses>(character, zone, options, cell.mass_ratio);
    const std::vector<bool> held = cell.held_end ? end_of(character) : std::vector<bool>{};
    // a held vertex does not jiggle
    for (std::size_t i = 0; i < std::min(held.size(), zone.size()); ++i) zone[i] = zone[i] && !held[i];
    return std::make_unique<Solved<pbs::PbsSolver>>(mesh, distance, zone, options, held);
}

constexpr int settled_for_good = 50;  // steps at rest after which a run ends early
constexpr int given_up_after = 2;     // consecutive steps that were not reached, after which a run ends early

struct Course {
    std::vector<analysis::StabilityStep> steps;
    pbs::Positions last;  // [m], #V x 3
    int disturbed_steps = 0;
    std::vector<int> iterations;  // of the method, by step
};

bool is_over(const Course& course)
{
    const auto& steps = course.steps;
    const auto reached = std::find_if(steps.rbegin(), steps.rend(), [](const auto& step) { return step.solved; });
    if (!steps.back().finite || reached - steps.rbegin() >= given_up_after) return true;
    return static_cast<int>(steps.size()) >= course.disturbed_steps + settled_for_good &&
           analysis::settled_steps(steps) >= settled_for_good;
}

std::optional<int> iterations_until_reached(const Course& course)
{
    const auto reached =
        std::find_if(course.steps.begin(), course.steps.end(), [](const auto& step) { return step.solved; });
    if (reached == course.steps.end()) return std::nullopt;
    return std::accumulate(course.iterations.begin(), course.iterations.begin() + (reached - course.steps.begin()) + 1,
                           0);
}

Course follow(const StabilityCell& cell, const pbs::Positions* undisturbed)
{
    StabilityBody body(cell);
    const pbs::Character& character = body.character();
    const auto driven = make_driven_body(cell, character);
    Course course{{}, body.drive(0).blended, body.disturbed_steps(), {}};
    for (int step = 0; step < body.steps(); ++step) {
        const Drive drive = body.drive(step);
        const pbs::StepSummary step_summary = driven->advance(drive, cell.time_step_s);
        course.steps.push_back(analysis::stability_step(course.last, driven->positions(),
                                                        {drive.bind_points, character.binding.distance},
                                                        character.mesh.tets, body.diagonal_m(), undisturbed));
        course.steps.back().solved = step_summary.outcome == pbs::Outcome::finished;
        course.iterations.push_back(step_summary.iterations);
        course.last = driven->positions();
        if (is_over(course)) break;
    }
    return course;
}

// The shape in which a body comes to rest that begins in the last pose, whether or not it has inverted tets.
std::optional<pbs::Positions> undisturbed_state(StabilityCell cell)
{
    cell.disturbance.stays = true;
    cell.disturbance.start = Start::none;
    Course course = follow(cell, nullptr);
    for (auto& step : course.steps) step.inverted_tets = 0;
    if (analysis::outcome_of(course.steps, course.disturbed_steps).outcome != analysis::StabilityOutcome::converged)
        return std::nullopt;
    return course.last;
}

// Cells that differ only in their disturbance share the undisturbed state.
const std::optional<pbs::Positions>& undisturbed_of(const StabilityCell& cell)
{
    static std::map<std::string, std::optional<pbs::Positions>> kept;
    const std::string key = setting_of(cell);
    const auto found = kept.find(key);
    return found != kept.end() ? found->second : kept.emplace(key, undisturbed_state(cell)).first->second;
}

constexpr double share_of_vertices = 0.05;

std::vector<std::vector<int>> tets_around(const pbs::TetMesh& mesh)
{
    std::vector<std::vector<int>> around(mesh.rest.rows());
    for (int t = 0; t < mesh.tets.rows(); ++t)
        for (const int v : mesh.tets.row(t)) around[v].push_back(t);
    return around;
}

// The new place of the vertex: closer to the plane of the tet's other three corners, or closer to one of them.
pbs::Vec3 moved(const pbs::TetMesh& mesh, int vertex, int tet, Defect defect, double thinness)
{
    std::vector<pbs::Vec3> others;
    for (const int v : mesh.tets.row(tet))
        if (v != vertex) others.push_back(mesh.rest.row(v));
    const pbs::Vec3 p = mesh.rest.row(vertex);
    if (defect == Defect::needles) return others[0] + thinness * (p - others[0]);
    const pbs::Vec3 normal = (others[1] - others[0]).cross(others[2] - others[0]).normalized();
    return p - (1.0 - thinness) * normal.dot(p - others[0]) * normal;
}

bool all_upright(const pbs::TetMesh& mesh, const std::vector<int>& tets)
{
    for (const int t : tets) {
        const auto corner = [&](int c) -> pbs::Vec3 { return mesh.rest.row(mesh.tets(t, c)); };
        if (!(pbs::tet_volume(corner(0), corner(1), corner(2), corner(3)) > 0.0)) return false;
    }
    return true;
}

}  // namespace

Scene stability_scene(const std::string& body)
{
    const std::string of_body = "character.body=" + body;
    if (pbs::is_character(body))
        return read_scene("human_01_01", {of_body, "motion.start_s=6.72", "motion.duration_s=0.36"});
    return read_scene("limb_bend", {of_body, "character.vertices=" + std::to_string(limb_vertices)});
}

const pbs::Character& stability_character(const StabilityCell& cell)
{
    static std::map<std::string, pbs::Character> kept;
    const std::string key =
        cell.body + std::to_string(static_cast<int>(cell.defect)) + std::to_string(std::log10(cell.thinness));
    if (const auto found = kept.find(key); found != kept.end()) return found->second;
    pbs::Character character = pbs::make_character(stability_scene(cell.body).character);
    if (cell.defect != Defect::none) character = spoilt(std::move(character), cell.defect, cell.thinness);
    return kept.emplace(key, std::move(character)).first->second;
}

StabilityBody::StabilityBody(const StabilityCell& cell)
    : character_(stability_character(cell)),
      way_(way_of(cell, character_.skeleton)),
      start_(cell.disturbance.start),
      still_steps_(cell.still_steps),
      diagonal_m_(pbs::diagonal_m(character_.mesh.rest))
{
}

Drive StabilityBody::drive(int step)
{
    const int posed = std::min(step, disturbed_steps() - 1);
    const pbs::Pose& pose = way_[posed];
    if (posed != posed_ || step <= 1) {
        pbs::linear_blend_skinning(character_.mesh.rest, character_.weights, pose, blended_);
        bind_points_ = pbs::posed_bind_points(character_.binding, pose);
    }
    if (step == 0) blended_ = started(start_, blended_);
    posed_ = posed;
    return {pose, blended_, bind_points_};
}

std::unique_ptr<DrivenBody> make_driven_body(const StabilityCell& cell, const pbs::Character& character)
{
    if (options_if<pbs::PbsOptions>(cell.spec)) return make_pbs(cell, character);
    if (const auto* xpbd = options_if<pbs::XpbdOptions>(cell.spec))
        return std::make_unique<Solved<pbs::XpbdSolver>>(character.mesh, character.binding.distance,
                                                         zone_of(character, xpbd->jiggle), *xpbd);
    return std::make_unique<Posed>(cell, character);
}

std::string endings_text()
{
    return fmt::format(
        "\nA run ends early when it is not finite, when the last {} steps all fulfil the bounds of `converged`, or "
        "when {} consecutive "
        "steps "
        "were\nnot reached (each further attempt would be expensive).\n",
        settled_for_good, given_up_after);
}

CellResult run_cell(const StabilityCell& cell)
{
    const double start_s = process_cpu_s();
    const std::optional<pbs::Positions>& undisturbed = undisturbed_of(cell);
    CellResult result;
    Course course = follow(cell, undisturbed ? &*undisturbed : nullptr);
    result.stability = analysis::outcome_of(course.steps, course.disturbed_steps);
    if (cell.disturbance.start != Start::none) result.iterations_until_reached = iterations_until_reached(course);
    result.steps_not_reached = static_cast<int>(
        std::count_if(course.steps.begin(), course.steps.end(), [](const auto& s) { return !s.solved; }));
    result.steps = std::move(course.steps);
    result.has_undisturbed = undisturbed.has_value();
    result.cpu_s = process_cpu_s() - start_s;
    return result;
}

pbs::TetMesh distorted(const pbs::TetMesh& mesh, Defect defect, double thinness)
{
    if (defect == Defect::none) return mesh;
    pbs::TetMesh spoilt = mesh;
    const auto around = tets_around(mesh);
    std::vector<int> order(mesh.rest.rows());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(stability_seed));
    std::vector<bool> touched(mesh.rest.rows(), false);
    int wanted = static_cast<int>(share_of_vertices * static_cast<double>(mesh.rest.rows()));
    for (const int vertex : order) {
        if (wanted == 0) break;
        if (touched[vertex]) continue;
        for (const int tet : around[vertex]) {
            const pbs::Vec3 before = spoilt.rest.row(vertex);
            spoilt.rest.row(vertex) = moved(spoilt, vertex, tet, defect, thinness);
            if (all_upright(spoilt, around[vertex])) {
                for (const int t : around[vertex])
                    for (const int v : mesh.tets.row(t)) touched[v] = true;
                --wanted;
                break;
            }
            spoilt.rest.row(vertex) = before;
        }
    }
    return spoilt;
}

}  // namespace experiments
