// The split of an error into solver, model and discretisation, on a coarse limb whose forearm is twisted: properties of its parts that do
// not depend on the flesh; and, for information, the effect of the attachment and of the bones' thickness.
#include "experiments/studies/verification/problem.hpp"
#include "reference_fem/verification/problems.hpp"

#include "analysis/metrics/error_norms.hpp"
#include "analysis/statistics/grid_convergence.hpp"
#include "experiments/deformers/fem/fem_deformers.hpp"
#include "pbs/skinning/blend.hpp"
#include "pbs/solver/pbs_solver.hpp"

#include <fmt/format.h>

#include <limits>
#include <numbers>

namespace experiments {

using namespace reference_fem;

namespace {

constexpr int coarse = 500;  // vertices
constexpr double angle_deg = 40.0;

std::vector<int> blended_vertices(const pbs::Character& character)
{
    std::vector<int> vertices;
    for (std::size_t i = 0; i < character.blended.size(); ++i)
        if (character.blended[i]) vertices.push_back(static_cast<int>(i));
    return vertices;
}

class TwistedLimb {
public:
    explicit TwistedLimb(pbs::Character limb)
        : limb_(std::move(limb)),
          pose_(pbs::joint_sweep(limb_.skeleton, 1, pbs::Vec3::UnitX(), angle_deg, 2, 0.01).steps.back()),
          norms_({limb_.mesh.rest, limb_.mesh.tets, {}, blended_vertices(limb_), limb_.binding.distance})
    {
    }

    // The values are not a number where the pose is not reached.
    pbs::Positions flesh(const FemOptions& options) const
    {
        ElasticFemDeformer deformer(options);
        deformer.reset(limb_);
        if (deformer.advance(pose_, 0.01).outcome == pbs::Outcome::finished) return deformer.positions();
        return pbs::Positions::Constant(limb_.mesh.rest.rows(), 3, std::numeric_limits<double>::quiet_NaN());
    }

    pbs::Positions skinned(int iterations) const
    {
        pbs::PbsOptions options;
        options.iterations = iterations;
        options.precision = pbs::Precision::f64;
        pbs::PbsSolver solver(limb_.mesh, limb_.binding.distance, {}, options);
        pbs::Positions blended;
        pbs::linear_blend_skinning(limb_.mesh.rest, limb_.weights, pose_, blended);
        solver.advance(blended, pbs::posed_bind_points(limb_.binding, pose_), 0.01);
        return solver.positions();
    }

    double distance_pct(const pbs::Positions& one, const pbs::Positions& other) const
    {
        return norms_.measure(one.topRows(limb_.mesh.rest.rows()), other.topRows(limb_.mesh.rest.rows())).joint_pct;
    }

    VerificationRow row(const RowQuantity& quantity, const std::string& unit, double value) const
    {
        return {.problem = "error_split",
                .quantity = quantity,
                .elements = elements_of(1),
                .material = material_of("neo_hookean", 0.45),
                .mesh = fmt::format("limb, {} vertices, twist of {:.0f} degrees", limb_.mesh.rest.rows(), angle_deg),
                .dofs = static_cast<int>(3 * limb_.mesh.rest.rows()),
                .value = value,
                .unit = unit};
    }

private:
    pbs::Character limb_;
    pbs::Pose pose_;
    analysis::ErrorMetrics norms_;
};

// In a norm, the whole lies between the difference and the sum of its two parts.
VerificationRow whole_and_parts(const TwistedLimb& limb, const pbs::Positions& flesh, int iterations)
{
    const pbs::Positions converged = limb.skinned(4000), stopped = limb.skinned(iterations);
    const double solver = limb.distance_pct(stopped, converged), model = limb.distance_pct(converged, flesh);
    VerificationRow row =
        limb.row({"error_over_parts", fmt::format("error after {} iterations over the sum of its solver and model parts", iterations),
                  fmt::format("iterations_{}", iterations)},
                 "1", limb.distance_pct(stopped, flesh) / (solver + model));
    row.reference = 1.0;
    row.low = std::abs(solver - model) / (solver + model) - 1e-12;
    row.high = 1.0 + 1e-12;
    row.source = row.bound_from = "closed form: triangle inequality of a norm; 1 where the parts point the same way";
    return row;
}

// The theoretical order that an error bar presumes with the smooth attachment (experiments/run/reference_error_bar.hpp).
constexpr double order_of_smooth_springs = 2.0;

// Compares the bound from P1 on two meshes with a solution of higher order on the finer one.
VerificationRow bound_covers(const TwistedLimb& limb, const TwistedLimb& refined, const pbs::Positions& flesh, const FemOptions& options)
{
    FemOptions quadratic = options;
    quadratic.element_order = 2;
    const double bound = analysis::two_fields(limb.distance_pct(refined.flesh(options), flesh), 2.0, order_of_smooth_springs).bounds[1];
    VerificationRow row = limb.row({"distance_over_bound", "distance from refined P2 flesh over the bound from two meshes of P1"}, "1",
                                   limb.distance_pct(refined.flesh(quadratic), flesh) / bound);
    row.low = 0.0;
    row.high = 1.0;
    row.source = row.bound_from = "P. J. Roache, Journal of Fluids Engineering 116, 1994: the index bounds the distance from the limit";
    return row;
}

VerificationRow variant(const TwistedLimb& limb, const pbs::Positions& flesh, const FemOptions& options, const std::string& key)
{
    VerificationRow row = limb.row({"distance_of_variant", "distance from flesh held by smooth springs, q 10, core 0.7: " + key, key},
                                   "% of the bone distance", limb.distance_pct(limb.flesh(options), flesh));
    row.source = "none: the effect of a choice, for information";
    return row;
}

}  // namespace

VerificationRows error_split_rows(const Effort& effort)
{
    if (!effort.limb) return {};
    const TwistedLimb limb(effort.limb(coarse, 0)), refined(effort.limb(coarse, 1));
    const FemOptions options = {.model = reference_fem::Model::neo_hookean, .element_order = 1};
    const pbs::Positions flesh = limb.flesh(options);
    FemOptions stiffer = options, thinner = options, embedded = options, bind = options;
    stiffer.spring_factor = 100.0;
    thinner.core_radius = 0.5;
    embedded.attachment = FemAttachment::embedded;
    bind.attachment = FemAttachment::bind;
    return {whole_and_parts(limb, flesh, 1),
            whole_and_parts(limb, flesh, 24),
            bound_covers(limb, refined, flesh, options),
            variant(limb, flesh, stiffer, "spring_factor_100"),
            variant(limb, flesh, thinner, "core_radius_0.5"),
            variant(limb, flesh, embedded, "embedded_bones"),
            variant(limb, flesh, bind, "bind_constraint_of_the_paper")};
}

}  // namespace experiments
