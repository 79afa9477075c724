#include "experiments/studies/timing/frame_timing.hpp"

#include "pbs/geometry/stopwatch.hpp"
#include "pbs/skinning/blend_skinning.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/projection.hpp"

#include <memory>

namespace experiments {
namespace {

enum Sample { lbs_s, bind_s, stretch_s, volume_s, rest_s, total_s, total_wall_s, surface_s, drawn_wall_s, samples };

pbs::PbsOptions without_iterations(pbs::PbsOptions options)
{
    options.iterations = 0;
    return options;
}

// One variant's way through the motion. What is projected class by class, so that each can be timed, sets out on the frame's LBS.
template <typename Scalar>
class TimedVariantFrames {
public:
    TimedVariantFrames(const pbs::Character& character, const pbs::Motion& motion, const pbs::PbsOptions& options, int frames_a_turn)
        : character_(character),
          motion_(motion),
          frames_a_turn_(frames_a_turn),
          zone_(pbs::jiggle_zone(character.binding)),
          skinning_(character.mesh.rest, character.weights),
          solver_(character.mesh, character.binding.distance, zone_, options),
          idle_solver_(character.mesh, character.binding.distance, zone_, without_iterations(options)),
          projection_(pbs::make_projection(pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, zone_, options),
                                           character.mesh.tets, options))
    {
    }

    std::vector<double> turn()
    {
        std::vector<double> seconds(samples, 0.0);
        for (int frame = 0; frame < frames_a_turn_; ++frame) {
            const pbs::Pose& pose = motion_.steps[next_];
            next_ = (next_ + 1) % motion_.steps.size();
            whole_frame(pose, seconds);
            idle_step(pose, seconds);
            parts(pose, seconds);
        }
        for (double& sum : seconds) sum /= frames_a_turn_;
        return seconds;
    }

private:
    void whole_frame(const pbs::Pose& pose, std::vector<double>& seconds)
    {
        const pbs::Stopwatch wall;
        const double start = thread_cpu_s();
        skinning_.linear(pose, lbs_);
        seconds[lbs_s] += thread_cpu_s() - start;
        solver_.advance(lbs_, pbs::posed_bind_points(character_.binding, pose), time_step_s);
        const double end = thread_cpu_s();
        seconds[total_s] += end - start;
        seconds[total_wall_s] += wall.seconds();
        if (!character_.surface) return;
        seconds[surface_s] +=
            cpu_seconds([&] { surface_ = pbs::embedded_positions(*character_.surface, solver_.positions(), character_.mesh.tets); });
        seconds[drawn_wall_s] += wall.seconds();
    }

    void idle_step(const pbs::Pose& pose, std::vector<double>& seconds)
    {
        seconds[rest_s] += cpu_seconds([&] { idle_solver_.advance(lbs_, pbs::posed_bind_points(character_.binding, pose), time_step_s); });
    }

    void parts(const pbs::Pose& pose, std::vector<double>& seconds)
    {
        projection_->load(lbs_, pbs::posed_bind_points(character_.binding, pose), pbs::Vec3::Zero());
        const auto time = [&](Sample of, void (pbs::Projection<Scalar>::*project)()) {
            seconds[of] += cpu_seconds([&] {
                for (int iteration = 0; iteration < timed_iterations; ++iteration) (projection_.get()->*project)();
            });
        };
        time(volume_s, &pbs::Projection<Scalar>::project_volume_constraints);
        time(stretch_s, &pbs::Projection<Scalar>::project_stretch_constraints);
        time(bind_s, &pbs::Projection<Scalar>::project_bind_constraints);
    }

    static constexpr double time_step_s = 0.01;

    const pbs::Character& character_;
    const pbs::Motion& motion_;
    int frames_a_turn_;
    std::vector<bool> zone_;
    pbs::BlendSkinning<double> skinning_;
    pbs::PbsSolver solver_, idle_solver_;
    std::unique_ptr<pbs::Projection<Scalar>> projection_;
    pbs::Positions lbs_, surface_;
    std::size_t next_ = 0;
};

struct NamedVariant {
    const char* name;
    pbs::Order order;
    pbs::Precision precision;
};
constexpr NamedVariant variants[] = {{"plain", pbs::Order::plain, pbs::Precision::f64},
                                     {"plain", pbs::Order::plain, pbs::Precision::f32},
                                     {"ordered", pbs::Order::ordered, pbs::Precision::f32}};

template <typename Scalar>
TimedVariant turns_of(const pbs::Character& character, const pbs::Motion& motion, const pbs::PbsOptions& options, int frames_a_turn)
{
    const auto frames = std::make_shared<TimedVariantFrames<Scalar>>(character, motion, options, frames_a_turn);
    return [frames] { return frames->turn(); };
}

FrameTiming summed_up(const NamedVariant& variant, const std::vector<std::vector<double>>& seconds, bool has_surface)
{
    const auto ms = [&](Sample of) { return scaled(spread_of(seconds[of]), 1e3); };
    return {variant.name,
            variant.precision == pbs::Precision::f32 ? "f32" : "f64",
            ms(lbs_s),
            ms(bind_s),
            ms(stretch_s),
            ms(volume_s),
            ms(rest_s),
            ms(total_s),
            ms(total_wall_s),
            has_surface ? ms(surface_s) : Spread{},
            has_surface ? ms(drawn_wall_s) : Spread{}};
}

}  // namespace

std::vector<FrameTiming> time_frames(const pbs::Character& character, const pbs::Motion& motion, const TimedFrames& timed,
                                     const Rounds& rounds)
{
    std::vector<TimedVariant> turns;
    for (const NamedVariant& variant : variants) {
        pbs::PbsOptions options;
        options.iterations = timed_iterations;
        options.order = variant.order;
        options.precision = variant.precision;
        options.gravity_m_s2 = {0.0, -9.81, 0.0};
        options.jiggle = pbs::Jiggle{timed.k_jiggle};
        turns.push_back(variant.precision == pbs::Precision::f32 ? turns_of<float>(character, motion, options, timed.frames_a_turn)
                                                                 : turns_of<double>(character, motion, options, timed.frames_a_turn));
    }
    const auto seconds = take_turns(turns, rounds);
    std::vector<FrameTiming> timings;
    for (std::size_t i = 0; i < turns.size(); ++i) timings.push_back(summed_up(variants[i], seconds[i], character.surface.has_value()));
    return timings;
}

}  // namespace experiments
