#include "experiments/studies/convergence/starts.hpp"

#include "experiments/process/terminal.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

namespace experiments {
namespace {

pbs::Positions blended(const pbs::Character& character, const pbs::Weights& weights, const pbs::Pose& pose)
{
    pbs::Positions positions;
    pbs::linear_blend_skinning(character.mesh.rest, weights, pose, positions);
    return positions;
}

// The solver advanced from step to step, each step from the result of the last one.
class WarmStarted {
public:
    WarmStarted(const pbs::Character& character, const pbs::Motion& motion, const pbs::PbsOptions& options)
        : character_(character),
          motion_(motion),
          solver_(character.mesh, character.binding.distance, {}, options),
          positions_(blended(character, character.weights, motion.steps.front()))
    {
    }

    const pbs::Positions& before(std::size_t step)
    {
        for (; next_ < step; ++next_) {
            stop_if_interrupted();
            solver_.advance(positions_, pbs::posed_bind_points(character_.binding, motion_.steps[next_]), motion_.time_step_s);
            positions_ = solver_.positions();
        }
        return positions_;
    }

private:
    const pbs::Character& character_;
    const pbs::Motion& motion_;
    pbs::PbsSolver solver_;
    pbs::Positions positions_;
    std::size_t next_ = 0;
};

}  // namespace

const char* name_of(SolverStart start)
{
    static constexpr const char* names[] = {"lbs", "previous_frame", "rest_pose", "rigid_bind"};
    return names[static_cast<int>(start)];
}

std::vector<FrameStarts> starts_of(const pbs::Character& character, const pbs::Motion& motion, const std::vector<int>& frames,
                                   const pbs::PbsOptions& options)
{
    const pbs::Weights rigid = pbs::rigid_weights(character.binding);
    WarmStarted warm(character, motion, options);
    std::vector<FrameStarts> all;
    for (const int frame : frames) {
        const std::size_t step = static_cast<std::size_t>(frame) * motion.steps_per_frame;
        const pbs::Pose& pose = motion.steps.at(step);
        all.push_back(
            {pbs::posed_bind_points(character.binding, pose),
             {blended(character, character.weights, pose), warm.before(step), character.mesh.rest, blended(character, rigid, pose)}});
    }
    return all;
}

}  // namespace experiments
