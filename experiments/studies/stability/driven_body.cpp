#include "experiments/studies/stability/driven_body.hpp"

#include "experiments/deformers/registry.hpp"
#include "experiments/deformers/xpbd/xpbd_solver.hpp"
#include "experiments/studies/stability/unequal_masses.hpp"
#include "pbs/solver/pbs_solver.hpp"

namespace experiments {
namespace {

std::vector<bool> zone_of(const pbs::Character& character, bool jiggles)
{
    return jiggles ? pbs::jiggle_zone(character.binding) : std::vector<bool>{};
}

// The last tenth of the body along x; what is held does not jiggle.
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
    pbs::StepSummary advance(const Drive& drive, double dt_s) override { return solver_.advance(drive.blended, drive.bind_points, dt_s); }
    const pbs::Positions& positions() const override { return solver_.positions(); }

private:
    Solver solver_;
};

// The finite elements: told the pose alone, and the shape they start from where it is a broken one.
class Posed : public DrivenBody {
public:
    Posed(const StabilityCell& cell, const pbs::Character& character)
        : deformer_(make_deformer(cell.spec)), is_to_start_(cell.disturbance.start != Start::none)
    {
        deformer_->reset(character);
    }
    pbs::StepSummary advance(const Drive& drive, double dt_s) override
    {
        if (is_to_start_) deformer_->start_from(drive.blended);
        is_to_start_ = false;
        return deformer_->advance(drive.pose, dt_s);
    }
    const pbs::Positions& positions() const override { return deformer_->positions(); }

private:
    std::unique_ptr<Deformer> deformer_;
    bool is_to_start_;
};

std::unique_ptr<DrivenBody> make_pbs(const StabilityCell& cell, const pbs::Character& character)
{
    const auto& options = options_of<pbs::PbsOptions>(cell.spec);
    std::vector<bool> zone = zone_of(character, options.jiggle.has_value());
    const pbs::TetMesh& mesh = character.mesh;
    const Eigen::VectorXd& distance = character.binding.distance;
    if (cell.mass_ratio > 1.0) return std::make_unique<Solved<UnequalMasses>>(mesh, distance, zone, options, cell.mass_ratio);
    const std::vector<bool> held = cell.held_end ? end_of(character) : std::vector<bool>{};
    for (std::size_t i = 0; i < std::min(held.size(), zone.size()); ++i) zone[i] = zone[i] && !held[i];
    return std::make_unique<Solved<pbs::PbsSolver>>(mesh, distance, zone, options, held);
}

}  // namespace

std::unique_ptr<DrivenBody> make_driven_body(const StabilityCell& cell, const pbs::Character& character)
{
    if (options_if<pbs::PbsOptions>(cell.spec)) return make_pbs(cell, character);
    if (const auto* xpbd = options_if<XpbdOptions>(cell.spec))
        return std::make_unique<Solved<XpbdSolver>>(character.mesh, character.binding.distance, zone_of(character, xpbd->jiggle), *xpbd);
    return std::make_unique<Posed>(cell, character);
}

}  // namespace experiments
