#include "experiments/studies/timing/frame_timing.hpp"

#include "experiments/deformers/deformer_options.hpp"
#include "pbs/geometry/cost.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/projection.hpp"

#include <memory>

namespace experiments {
namespace {

enum Sample { lbs_s, bind_s, stretch_s, volume_s, rest_s, total_s, total_wall_s, surface_s, drawn_wall_s, samples };

constexpr std::pair<pbs::Order, pbs::Precision> variants[] = {
    {pbs::Order::plain, pbs::Precision::f64}, {pbs::Order::plain, pbs::Precision::f32}, {pbs::Order::ordered, pbs::Precision::f32}};

pbs::PbsOptions without_iterations(pbs::PbsOptions options)
{
    options.iterations = 0;
    return options;
}

// One variant on its way through the motion.
template <typename Scalar>
class VariantFrames {
public:
    VariantFrames(const pbs::Character& character, const pbs::PbsOptions& options)
        : character_(character),
          zone_(pbs::jiggle_zone(character.binding)),
          skinning_(character.mesh.rest, character.weights),
          solver_(character.mesh, character.binding.distance, zone_, options),
          idle_solver_(character.mesh, character.binding.distance, zone_, without_iterations(options)),
          projection_(pbs::make_projection(pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, zone_, options),
                                           character.mesh.tets, options))
    {
    }

    // Adds the samples of a frame.
    void add_frame(const pbs::Pose& pose, std::vector<double>& seconds)
    {
        constexpr double time_step_s = 0.01;
        const auto bind_points = [&] { return pbs::posed_bind_points(character_.binding, pose); };
        const pbs::Stopwatch wall;
        const double lbs = cpu_seconds([&] { skinning_.linear(pose, lbs_); });
        seconds[lbs_s] += lbs;
        seconds[total_s] += lbs + cpu_seconds([&] { solver_.advance(lbs_, bind_points(), time_step_s); });
        seconds[total_wall_s] += wall.seconds();
        if (character_.surface) {
            seconds[surface_s] +=
                cpu_seconds([&] { surface_ = pbs::embedded_positions(*character_.surface, solver_.positions(), character_.mesh.tets); });
            seconds[drawn_wall_s] += wall.seconds();
        }
        seconds[rest_s] += cpu_seconds([&] { idle_solver_.advance(lbs_, bind_points(), time_step_s); });

        // Each class by itself, which is for timing alone, from the frame's LBS.
        using Projection = pbs::Projection<Scalar>;
        projection_->load(lbs_, bind_points(), pbs::Vec3::Zero());
        for (const auto& [sample, project] :
             {std::pair(volume_s, &Projection::project_volume_constraints), std::pair(stretch_s, &Projection::project_stretch_constraints),
              std::pair(bind_s, &Projection::project_bind_constraints)})
            seconds[sample] += cpu_seconds([&, project = project] {
                for (int iteration = 0; iteration < timed_iterations; ++iteration) (projection_.get()->*project)();
            });
    }

private:
    const pbs::Character& character_;
    std::vector<bool> zone_;
    pbs::BlendSkinning<double> skinning_;
    pbs::PbsSolver solver_, idle_solver_;
    std::unique_ptr<pbs::Projection<Scalar>> projection_;
    pbs::Positions lbs_, surface_;
};

template <typename Scalar>
TimedVariant turns_of(const pbs::Character& character, const pbs::Motion& motion, const pbs::PbsOptions& options, int frames_per_turn)
{
    const auto frames = std::make_shared<VariantFrames<Scalar>>(character, options);
    return [frames, &motion, frames_per_turn, next = std::size_t(0)]() mutable {
        std::vector<double> seconds(samples, 0.0);
        for (int frame = 0; frame < frames_per_turn; ++frame) frames->add_frame(motion.steps[next++ % motion.steps.size()], seconds);
        for (double& sum : seconds) sum /= frames_per_turn;
        return seconds;
    };
}

FrameTiming summed_up(pbs::Order order, pbs::Precision precision, const Samples& seconds, bool has_surface)
{
    const auto ms = [&](Sample of) { return scaled(spread_of(seconds[of]), 1e3); };
    FrameTiming timing{name_of(order), name_of(precision), ms(lbs_s),   ms(bind_s),      ms(stretch_s),
                       ms(volume_s),   ms(rest_s),         ms(total_s), ms(total_wall_s)};
    if (has_surface) timing.surface_ms = ms(surface_s), timing.drawn_wall_ms = ms(drawn_wall_s);
    return timing;
}

}  // namespace

std::vector<FrameTiming> time_frames(const pbs::Character& character, const pbs::Motion& motion, const TimedFrames& timed,
                                     const Rounds& rounds)
{
    std::vector<TimedVariant> turns;
    for (const auto& [order, precision] : variants) {
        pbs::PbsOptions options;
        options.iterations = timed_iterations;
        options.order = order;
        options.precision = precision;
        options.gravity_m_s2 = {0.0, -9.81, 0.0};
        options.jiggle = pbs::Jiggle{timed.k_jiggle};
        turns.push_back(precision == pbs::Precision::f32 ? turns_of<float>(character, motion, options, timed.frames_per_turn)
                                                         : turns_of<double>(character, motion, options, timed.frames_per_turn));
    }
    const std::vector<Samples> seconds = take_turns(turns, rounds);
    std::vector<FrameTiming> timings;
    for (std::size_t i = 0; i < turns.size(); ++i)
        timings.push_back(summed_up(variants[i].first, variants[i].second, seconds[i], character.surface.has_value()));
    return timings;
}

}  // namespace experiments
