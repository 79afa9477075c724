// PBS's rows of the locking table: the effect of one volume constraint per tet on the cantilever of cantilever.cpp.
//   tip deflection   of linear tets with a given shear modulus that keep every volume exactly, the limit of P1 as nu
//                    goes to 1/2
//   motions left     by the constraints on the free vertices, by rank; by counting, fewer than none are left
//   sag              of PBS itself, settled under its own weight (k_stretch gives the stiffness), with volume
//                    constraints over without
// The sag is 5/6 where the constraints do no more than incompressibility does: edges alone are a body of central
// forces, with nu = 1/4 and E = 2.5 mu, and where no volume changes E = 3 mu.
#include "experiments/studies/shared/iteration_path.hpp"
#include "experiments/studies/verification/problem.hpp"
#include "pbs/geometry/topology.hpp"
#include "pbs/near_rest/near_rest.hpp"
#include "reference_fem/verification/problems.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace experiments {

using namespace reference_fem;

namespace {

using pbs::Positions;
using pbs::Vec3;
using reference_fem::Formulation;

constexpr double young_pa = 1.0e5, length_m = 10.0;  // of cantilever.cpp

struct Clamped {
    pbs::TetMesh bar;
    std::vector<bool> held;
    Divisions divisions;
};

Clamped clamped_bar(int across)
{
    Clamped clamped{
        box_mesh({0, 0, 0}, {length_m, 1, 1}, {8 * across, across, across}), {}, {8 * across, across, across}};
    for (const auto& vertex : clamped.bar.rest.rowwise()) clamped.held.push_back(vertex(0) < 1e-9);
    return clamped;
}

// A shear traction of 1 N over the end of 1 m^2, along -z [N], #V x 3.
Positions end_load(const pbs::TetMesh& bar)
{
    Positions load = Positions::Zero(bar.rest.rows(), 3);
    const pbs::Triangles boundary = pbs::boundary_of(bar.tets);
    for (const auto& triangle : boundary.rowwise()) {
        const Vec3 a = bar.rest.row(triangle(0)), b = bar.rest.row(triangle(1)), c = bar.rest.row(triangle(2));
        if (std::min({a.x(), b.x(), c.x()}) < length_m - 1e-9) continue;
        for (const int v : triangle) load(v, 2) -= pbs::triangle_area(a, b, c) / 3.0;
    }
    return load;
}

RowSolution on(const Clamped& clamped, const std::string& formulation, const RowMaterial& material)
{
    const int dofs = 3 * static_cast<int>(clamped.bar.rest.rows());
    return {"locking", {.formulation = formulation}, material, text_of(clamped.divisions), 1.0 / clamped.divisions[1],
            dofs};
}

// The deflection is linear in 1 / lambda as lambda grows, with an error of the second order. A tenth of the difference
// between two deflections of P1 is a generous bound on the error of the line through them.
VerificationRows deflection_rows(const Effort& effort, const Clamped& clamped)
{
    const Positions load = end_load(clamped.bar);
    const pbs::VolumeConstraints volumes(clamped.bar, clamped.held);
    const double deflection_m = volumes.equilibrium(load, young_pa / 3.0).cwiseProduct(load).sum();
    const auto p1 = [&](double nu) {
        return cantilever_row(effort, nu, 1, Formulation::displacement, clamped.divisions);
    };
    const VerificationRow near = p1(0.4999), nearer = p1(0.49999);

    const RowSolution solution = on(clamped, "volume_constraints", linear_material(0.5));
    VerificationRow beam = row_about(solution, {"tip_deflection", "tip deflection"}, deflection_m, nearer.reference,
                                     "m", nearer.source + ", at nu = 0.49999");
    beam.note = "the share of bending that one volume constraint a tet leaves";

    // 1 - 2 nu is in proportion to mu / lambda
    const double per_difference = (1.0 - 2.0 * 0.49999) / (2.0 * (0.49999 - 0.4999));
    const double tolerance_m = 0.1 * std::abs(near.value - nearer.value);
    VerificationRow limit = row_about(solution, {"tip_deflection_of_p1_limit", "tip deflection, against P1's limit"},
                                      deflection_m, nearer.value - per_difference * (near.value - nearer.value), "m",
                                      "P1 at nu = 0.4999 and 0.49999, extrapolated along 1 / lambda to 0");
    bound(limit, limit.reference - tolerance_m, limit.reference + tolerance_m,
          "a tenth of the difference of the two: the line's error is of the second order");
    limit.note = "the same constraints: grad C of the paper is the divergence of P1";
    return {beam, limit};
}

VerificationRow count_row(const Clamped& clamped)
{
    const pbs::VolumeConstraints volumes(clamped.bar, clamped.held);
    const int rank = volumes.rank();
    VerificationRow row =
        row_about(on(clamped, "volume_constraints", {}), {"share_of_motions_left", "motions left, share of all"},
                  1.0 - static_cast<double>(rank) / volumes.dofs(),
                  1.0 - static_cast<double>(volumes.constraints()) / volumes.dofs(), "1",
                  "counting one constraint a tet, as if all were independent");
    row.note =
        fmt::format("{} constraints of rank {} on {} free components", volumes.constraints(), rank, volumes.dofs());
    return row;
}

double sag_over_dt2(const Clamped& clamped, double k_stretch, double k_volume)
{
    pbs::PbsOptions options;
    options.iterations = paper_iterations;
    options.k_stretch = k_stretch;
    options.k_volume = k_volume;
    options.masses = pbs::Masses::lumped;
    const pbs::RestingState state = pbs::settle(clamped.bar, clamped.held, options, -Vec3::UnitZ());
    return state.converged ? state.displacement.cwiseAbs().maxCoeff() : not_reached;
}

VerificationRows sag_rows(const Clamped& clamped, double k_stretch)
{
    VerificationRows rows;
    const double without = sag_over_dt2(clamped, k_stretch, 0.0);
    for (const double k_volume : {0.01, 0.1, 1.0}) {
        const std::string setting =
            fmt::format("k_stretch_{:g}_k_volume_{:g}_{}_iterations", k_stretch, k_volume, paper_iterations);
        rows.push_back(row_about(on(clamped, "pbs", {}),
                                 {"sag_ratio", "sag over sag without volume constraints, " + setting, setting},
                                 sag_over_dt2(clamped, k_stretch, k_volume) / without, 5.0 / 6.0, "1",
                                 "closed form: E = 2.5 mu of central forces, 3 mu where no volume changes"));
        rows.back().note = "below the reference: locking";
    }
    return rows;
}

}  // namespace

VerificationRows pbs_locking_rows(const Effort& effort)
{
    VerificationRows rows;
    for (const int across : {2, 3, 6}) {
        if (across == 6 && !effort.full) continue;
        const Clamped clamped = clamped_bar(across);
        for (const VerificationRow& row : deflection_rows(effort, clamped)) rows.push_back(row);
        if (across < 6) rows.push_back(count_row(clamped));
        for (const double k_stretch : {0.2, 0.9})
            for (const VerificationRow& row : sag_rows(clamped, k_stretch)) rows.push_back(row);
    }
    return rows;
}

}  // namespace experiments
