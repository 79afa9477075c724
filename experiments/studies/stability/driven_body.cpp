#include "experiments/studies/stability/driven_body.hpp"

#include "experiments/deformers/registry.hpp"
#include "pbs/solver/particles.hpp"
#include "pbs/solver/pbs_solver.hpp"
#include "pbs/solver/projection.hpp"
#include "pbs/solver/xpbd_solver.hpp"

#include <cmath>
#include <random>

namespace experiments {
namespace {

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
    pbs::StepSummary advance(const Drive& drive, double dt_s) override { return solver_.advance(drive.blended, drive.bind_points, dt_s); }
    const pbs::Positions& positions() const override { return solver_.positions(); }

private:
    Solver solver_;
};

// Algorithm 1 with particles of unequal masses, which the paper's m_i = 1 excludes: seeded masses from 1 to `ratio` with logarithms that
// are uniformly distributed over the vertices.
template <typename Scalar>
class UnequalMasses : public DrivenBody {
public:
    UnequalMasses(const pbs::Character& character, const std::vector<bool>& jiggle_zone, const pbs::PbsOptions& options, double ratio)
        : options_(options), particles_(character.mesh.rest, jiggle_zone, options)
    {
        auto constraints = pbs::make_constraint_set<Scalar>(character.mesh, character.binding.distance, jiggle_zone, options);
        std::mt19937 engine(stability_seed);
        std::uniform_real_distribution<double> share(0.0, 1.0);
        for (Scalar& inverse_mass : constraints.inverse_mass) inverse_mass = static_cast<Scalar>(std::pow(ratio, -share(engine)));
        projection_ = pbs::make_projection<Scalar>(std::move(constraints), character.mesh.tets, options);
    }
    pbs::StepSummary advance(const Drive& drive, double dt_s) override
    {
        particles_.predict(drive.blended, dt_s);
        const pbs::Vec3 origin = pbs::local_origin<Scalar>(particles_.predicted());
        projection_->load(particles_.predicted(), drive.bind_points, origin);
        for (int iteration = 0; iteration < options_.iterations; ++iteration) {
            projection_->project_bind_constraints();
            projection_->project_stretch_constraints();
            projection_->project_volume_constraints();
        }
        projection_->store(origin, particles_.predicted());
        particles_.update(dt_s);
        pbs::StepSummary summary;
        summary.iterations = options_.iterations;
        if (!particles_.positions().allFinite()) summary.outcome = pbs::Outcome::not_finite;
        return summary;
    }
    const pbs::Positions& positions() const override { return particles_.positions(); }

private:
    pbs::PbsOptions options_;
    pbs::Particles particles_;
    std::unique_ptr<pbs::Projection<Scalar>> projection_;
};

// The deformers of the registry. They take only the pose and, where the initial state is broken, its shape.
class Posed : public DrivenBody {
public:
    Posed(const StabilityCell& cell, const pbs::Character& character)
        : deformer_(make_deformer(cell.spec)), is_to_start_(cell.disturbance.start != Start::none), nudge_m_(cell.nudge_m)
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
    if (cell.mass_ratio > 1.0 && options.precision == pbs::Precision::f32)
        return std::make_unique<UnequalMasses<float>>(character, zone, options, cell.mass_ratio);
    if (cell.mass_ratio > 1.0) return std::make_unique<UnequalMasses<double>>(character, zone, options, cell.mass_ratio);
    const std::vector<bool> held = cell.held_end ? end_of(character) : std::vector<bool>{};
    for (std::size_t i = 0; i < std::min(held.size(), zone.size()); ++i) zone[i] = zone[i] && !held[i];  // a held vertex does not jiggle
    return std::make_unique<Solved<pbs::PbsSolver>>(mesh, distance, zone, options, held);
}

}  // namespace

std::unique_ptr<DrivenBody> make_driven_body(const StabilityCell& cell, const pbs::Character& character)
{
    if (options_if<pbs::PbsOptions>(cell.spec)) return make_pbs(cell, character);
    if (const auto* xpbd = options_if<pbs::XpbdOptions>(cell.spec))
        return std::make_unique<Solved<pbs::XpbdSolver>>(character.mesh, character.binding.distance, zone_of(character, xpbd->jiggle),
                                                         *xpbd);
    return std::make_unique<Posed>(cell, character);
}

}  // namespace experiments
