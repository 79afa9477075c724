// A bar of stable neo-Hookean flesh whose one end the skeleton turns about the axis, starting smoothly: theta = 1.5 (1
// - cos(3 t)) / 2.
//
//   ####========================|      held whole at one end (nodes) or at five points by springs (embedded)
//   ####========================|      gravity, Rayleigh damping
//
// No closed form: the order in the time step is seen against a step eight times finer than the finest, which leaves
// 0.02 of it open.
#include "reference_fem/elastic_body.hpp"
#include "reference_fem/verification/problems.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace reference_fem {
namespace {

using pbs::Positions;

constexpr double end_s = 0.8, cell_m = 0.1;
const Divisions divisions = {6, 2, 2};

struct Skeleton {
    std::string key;
    pbs::TetMesh mesh;
    Attachment attachment;

    Targets targets(double time_s) const
    {
        const double angle = 0.75 * (1.0 - std::cos(3.0 * time_s));
        const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, pbs::Vec3::UnitX()).toRotationMatrix().transpose();
        return {attachment.spring_points * turn, mesh.rest * turn, {}};
    }
};

Skeleton skeleton(bool by_springs)
{
    Skeleton skeleton{by_springs ? "springs" : "prescribed_tets",
                      box_mesh({0, -0.1, -0.1}, {0.6, 0.1, 0.1}, divisions),
                      {Positions(0, 3), {}, {}, {}, {}}};
    Attachment& held = skeleton.attachment;
    if (by_springs) {
        held.spring_points.resize(5, 3);
        held.spring_points << 0.05, 0, 0, 0.05, 0.05, 0, 0.05, 0, 0.05, 0.05, -0.05, 0, 0.05, 0, -0.05;
        held.spring_stiffness = Eigen::VectorXd::Constant(5, 2e3);
        return skeleton;
    }
    for (int t = 0; t < skeleton.mesh.tets.rows(); ++t) {
        const auto corners = skeleton.mesh.tets.row(t);
        if (std::all_of(corners.begin(), corners.end(),
                        [&](int v) { return skeleton.mesh.rest(v, 0) < cell_m + 1e-9; }))
            held.prescribed_tets.push_back(t);
    }
    return skeleton;
}

ElasticBody body_of(const Effort& effort, const Skeleton& skeleton, Dynamics dynamics)
{
    const ElasticMaterial material = solver_material(effort, {2e4, 0.3});
    ElasticOptions options;
    options.element_order = 1;
    options.young_pa = material.young_pa;
    options.poisson = material.poisson;
    options.dynamics = dynamics;
    options.rayleigh_mass_1_s = 0.5;
    options.rayleigh_stiffness_s = 0.01;
    options.newton.relative_tolerance = 1e-10;
    return {skeleton.mesh, options, skeleton.attachment};
}

// Vertices at the end [m]; empty where a step failed.
Positions end_of(const Effort& effort, const Skeleton& skeleton, Dynamics dynamics, int steps)
{
    ElasticBody body = body_of(effort, skeleton, dynamics);
    const double step_s = end_s / steps;
    for (int k = 0; k < steps; ++k) {
        const auto targets_at = [&](double fraction) { return skeleton.targets((k + fraction) * step_s); };
        if (!body.advance(targets_at, {0, 0, -1}, step_s).converged()) return {};
    }
    return body.positions();
}

void add_orders(const Effort& effort, const Skeleton& skeleton, Dynamics dynamics, VerificationRows& rows)
{
    const Positions reference = end_of(effort, skeleton, dynamics, 320);
    for (const int steps : {20, 40}) {
        const Positions end = end_of(effort, skeleton, dynamics, steps);
        const bool reached = end.rows() > 0 && reference.rows() > 0;
        const std::string scheme = dynamics == Dynamics::newmark ? "newmark" : "generalised-alpha_rho_0.8";
        const std::string setting = fmt::format("{}_{}_step_{:.0f}_ms", scheme, skeleton.key, 1e3 * end_s / steps);
        VerificationRow row =
            row_about({"moving_skeleton", elements_of(1), material_of("stable_neo_hookean", 0.3), text_of(divisions),
                       cell_m, static_cast<int>(3 * skeleton.mesh.rest.rows())},
                      {"distance_to_fine_step", "distance to a step of 2.5 ms, " + setting, setting},
                      reached ? (end - reference).norm() / std::sqrt(double(end.rows())) : not_reached, 0.0, "m",
                      "this solver with a step eight times finer than the finest");
        row.note = "order in the time step";
        if (steps > 20) expect_order(row, order_between(rows.back().value, row.value), 2.0, scheme_theory);
        rows.push_back(row);
    }
}

}  // namespace

VerificationRows moving_skeleton_rows(const Effort& effort)
{
    VerificationRows rows;
    for (const bool by_springs : {false, true})
        for (const Dynamics dynamics : {Dynamics::newmark, Dynamics::generalized_alpha})
            add_orders(effort, skeleton(by_springs), dynamics, rows);
    return rows;
}

}  // namespace reference_fem
