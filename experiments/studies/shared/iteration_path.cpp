#include "experiments/studies/shared/iteration_path.hpp"

#include "analysis/statistics/fits.hpp"
#include "analysis/verdicts/measurement.hpp"
#include "experiments/studies/shared/posed_reference.hpp"
#include "pbs/solver/batched/batched_projection.hpp"
#include "pbs/solver/particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>

namespace experiments {
namespace {

template <typename Scalar>
std::vector<IterationPath> iterate_in(const pbs::Character& character, const pbs::PbsOptions& options,
                                      const pbs::Positions& bind_points, const std::vector<pbs::Positions>& starts,
                                      int most, const IterationMetrics& iteration_metrics)
{
    pbs::Positions start;
    const StepLoops loops =
        step_loops(pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, {}, options),
                   character.mesh.tets, options, {start, bind_points});
    std::vector<IterationPath> paths;
    for (const pbs::Positions& each : starts) {
        start = each;
        paths.push_back(follow(loops, start, most, iteration_metrics));
    }
    return paths;
}

Reached reached(const IterationPath& path, double Look::*value, double bound)
{
    Reached result{path.looks.back().iteration, false};
    for (auto look = path.looks.rbegin(); look != path.looks.rend() && (*look).*value <= bound; ++look)
        result = {look->iteration, true};
    return result;
}

// Fisher and Yates. std::shuffle may draw its numbers differently in another standard library.
template <typename Constraint>
void shuffle(std::vector<Constraint>& constraints, std::mt19937_64& engine)
{
    for (std::size_t left = constraints.size(); left > 1; --left)
        std::swap(constraints[left - 1], constraints[engine() % left]);
}

}  // namespace

IterationMetrics::IterationMetrics(const pbs::Character& character, const pbs::Positions& bind_points,
                                   const PosedReference* reference)
    : mesh_metrics_(character.mesh.rest, character.mesh.tets),
      bind_points_(bind_points),
      bind_distance_(character.binding.distance),
      reference_(reference)
{
}

Look IterationMetrics::measure(int iteration, const pbs::Positions& positions) const
{
    const analysis::FrameMetrics metrics = mesh_metrics_.measure(positions);
    Look look;
    look.iteration = iteration;
    look.stretch_rms = metrics.stretch_rms;
    look.volume_rms = std::sqrt((mesh_metrics_.volume_ratios(positions).array() - 1.0).square().mean());
    look.bind_rms_m = analysis::bind_rms(positions, bind_points_, bind_distance_);
    const double bind_rms = look.bind_rms_m / bind_distance_.mean();
    look.combined = std::sqrt(
        (look.stretch_rms * look.stretch_rms + look.volume_rms * look.volume_rms + bind_rms * bind_rms) / 3.0);
    look.volume_change_pct = metrics.volume_change_pct;
    look.volume_abs_change_pct = metrics.volume_abs_change_pct;
    look.inverted_tets = metrics.inverted_tets;
    look.error_joint_pct = look.whole_joint_pct = std::numeric_limits<double>::quiet_NaN();
    if (reference_ && positions.allFinite()) {
        look.error_joint_pct = reference_->error_of(positions).joint_pct;
        look.whole_joint_pct = reference_->error_on_whole_body(positions).joint_pct;
    }
    return look;
}

std::vector<int> looked_at(int most)
{
    constexpr int each = 64;
    constexpr double step = 1.02;
    std::vector<int> looks;
    for (int iteration = 0; iteration < most;
         iteration = iteration < each ? iteration + 1 : int(std::ceil(step * iteration)))
        looks.push_back(iteration);
    looks.push_back(most);
    return looks;
}

template <typename Scalar>
StepLoops step_loops(const pbs::ConstraintSet<Scalar>& constraints, const pbs::Tets& tets,
                     const pbs::PbsOptions& options, const StepStart& start)
{
    struct State {
        pbs::Vec3 origin = pbs::Vec3::Zero();
        pbs::Positions positions;
    };
    const std::shared_ptr<pbs::Projection<Scalar>> projection = pbs::make_projection(constraints, tets, options);
    const auto state = std::make_shared<State>();
    StepLoops loops;
    loops.load = [projection, state, start] {
        if (start.has_local_origin) state->origin = pbs::local_origin<Scalar>(start.guess);
        projection->load(start.guess, start.bind_points, state->origin);
    };
    loops.bind = [projection] { projection->project_bind_constraints(); };
    loops.stretch = [projection] { projection->project_stretch_constraints(); };
    loops.volume = [projection] { projection->project_volume_constraints(); };
    loops.store = [projection, state, start]() -> const pbs::Positions& {
        state->positions.resize(start.guess.rows(), 3);
        projection->store(state->origin, state->positions);
        return state->positions;
    };
    loops.residuals = [projection] { return projection->residuals(); };
    if (const auto* batched = dynamic_cast<const pbs::BatchedProjection<Scalar>*>(projection.get())) {
        loops.stretch_fill = batched->stretch_fill();
        loops.volume_fill = batched->volume_fill();
    }
    return loops;
}

template StepLoops step_loops(const pbs::ConstraintSet<float>&, const pbs::Tets&, const pbs::PbsOptions&,
                              const StepStart&);
template StepLoops step_loops(const pbs::ConstraintSet<double>&, const pbs::Tets&, const pbs::PbsOptions&,
                              const StepStart&);

IterationPath follow(const StepLoops& loops, const pbs::Positions& guess, int most,
                     const IterationMetrics& iteration_metrics)
{
    IterationPath path{{}, guess};
    loops.load();
    int iteration = 0;
    for (const int look : looked_at(most)) {
        for (; iteration < look; ++iteration) loops.iterate();  // (11) to (13)
        if (look > 0) path.last = loops.store();
        path.finite = path.last.allFinite();
        path.looks.push_back(iteration_metrics.measure(look, path.last));
        if (!path.finite) break;
    }
    return path;
}

std::vector<IterationPath> iterate(const pbs::Character& character, const pbs::PbsOptions& options,
                                   const pbs::Positions& bind_points, const std::vector<pbs::Positions>& starts,
                                   int most, const IterationMetrics& iteration_metrics)
{
    pbs::PbsOptions own = options;
    own.jiggle.reset();
    own.sleep = false;
    return own.precision == pbs::Precision::f32
               ? iterate_in<float>(character, own, bind_points, starts, most, iteration_metrics)
               : iterate_in<double>(character, own, bind_points, starts, most, iteration_metrics);
}

double floor_of(const std::vector<IterationPath>& paths)
{
    double floor = analysis::not_known;
    for (const IterationPath& path : paths)
        if (path.finite && !(path.looks.back().combined >= floor)) floor = path.looks.back().combined;
    return floor;
}

Reached reached_residual(const IterationPath& path, double floor)
{
    return reached(path, &Look::combined, std::max((1.0 + residual_tolerance) * floor, satisfied_residual));
}

Reached reached_volume(const IterationPath& path)
{
    return reached(path, &Look::volume_abs_change_pct, analysis::kept_volume_pct);
}

double rate_of(const IterationPath& path, double floor)
{
    constexpr double unchanged = 0.01;
    const Look &last = path.looks.back(), &half = look_at(path, last.iteration / 2);
    if (last.combined < satisfied_residual) return analysis::not_known;
    int until = last.iteration;
    if (std::abs(last.combined / half.combined - 1.0) < unchanged) {
        floor = last.combined;
        until = reached_residual(path, floor).iterations;
    }
    std::vector<double> iterations, excess;
    for (const Look& look : path.looks)
        if (look.iteration > 0 && look.iteration <= until && look.combined > floor) {
            iterations.push_back(look.iteration);
            excess.push_back(std::log(look.combined - floor));
        }
    return iterations.size() < 3 ? analysis::not_known : std::exp(analysis::fit_line(iterations, excess).estimate);
}

const Look& look_at(const IterationPath& path, int iteration)
{
    const auto after = std::ranges::upper_bound(path.looks, iteration, {}, &Look::iteration);
    return after == path.looks.begin() ? path.looks.front() : *std::prev(after);
}

const Look& nearest_to_reference(const IterationPath& path)
{
    return *std::ranges::min_element(path.looks, {}, &Look::error_joint_pct);
}

template <typename Scalar>
void in_random_sequence(pbs::ConstraintSet<Scalar>& constraints, unsigned seed)
{
    std::mt19937_64 engine(seed);
    shuffle(constraints.stretch, engine);
    shuffle(constraints.volume, engine);
}

template void in_random_sequence(pbs::ConstraintSet<float>&, unsigned);
template void in_random_sequence(pbs::ConstraintSet<double>&, unsigned);

}  // namespace experiments
