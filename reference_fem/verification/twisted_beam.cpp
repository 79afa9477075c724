// MacNeal and Harder's twisted beam: 12 x 1.1 x 0.32 in, turned by 90 degrees from the clamp to the tip, E = 29e6 psi, nu = 0.22, a unit
// load at the tip. At the clamp the width lies along y, at the tip along z. A load along z lies in the plane of the tip's width and bends
// the beam about its thin side where the moment is largest: the large deflection; a load along y is out of that plane.
//
// Beam theory alone determines which value belongs to which load: deflection = P / E times the integral of
// s^2 (cos^2 phi / I_width + sin^2 phi / I_thickness), s the distance to the tip, phi the angle between the load and the width.
#include "reference_fem/verification/common.hpp"
#include "reference_fem/verification/structured_mesh.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace reference_fem {
namespace {

using pbs::Vec3;

constexpr double length_in = 12.0, width_in = 1.1, thickness_in = 0.32;
const ElasticMaterial material{29.0e6, 0.22};

double turn(double x)
{
    return std::numbers::pi / 2.0 * x / length_in;
}

pbs::TetMesh beam(const Divisions& divisions)
{
    return mapped(box_mesh({0, -width_in / 2.0, -thickness_in / 2.0}, {length_in, width_in / 2.0, thickness_in / 2.0}, divisions),
                  [](const Vec3& p) -> Vec3 {
                      const double c = std::cos(turn(p.x())), s = std::sin(turn(p.x()));
                      return {p.x(), c * p.y() - s * p.z(), s * p.y() + c * p.z()};
                  });
}

// Bending alone, Simpson's rule.
double beam_theory(const Vec3& load)
{
    const double along_width = thickness_in * std::pow(width_in, 3) / 12.0, along_thickness = width_in * std::pow(thickness_in, 3) / 12.0;
    const auto integrand = [&](double x) {
        const Vec3 width(0.0, std::cos(turn(x)), std::sin(turn(x)));
        const double share = std::pow(load.dot(width), 2);
        return std::pow(length_in - x, 2) * (share / along_width + (1.0 - share) / along_thickness) / material.young_pa;
    };
    const int n = 200;
    double sum = integrand(0.0) + integrand(length_in);
    for (int i = 1; i < n; ++i) sum += (i % 2 ? 4.0 : 2.0) * integrand(length_in * i / n);
    return sum * length_in / (3.0 * n);
}

VerificationRow row_of(const Effort& effort, const Vec3& load, int element_order, const Divisions& divisions)
{
    const BoundaryValueSolution solution =
        solve(beam(divisions), solver_material(effort, material),
              {.held = [](const Vec3& x) { return x.x() < 1e-9; },
               .element_order = element_order,
               .tractions = {{[](const Vec3& centre) { return centre.x() > length_in - 1e-6; },
                              [&](const Vec3&, const Vec3&) -> Vec3 { return load / (width_in * thickness_in); }}}});
    const bool in_plane = load.z() != 0.0;
    char note[120];
    std::snprintf(note, sizeof note, "beam theory, bending alone: %.6f in", beam_theory(load));
    return {.problem = "twisted_beam",
            .quantity = in_plane ? RowQuantity{"tip_deflection_in_plane", "tip deflection, load along the tip's width (in plane)"}
                                 : RowQuantity{"tip_deflection_out_of_plane", "tip deflection, load across the tip's width (out of plane)"},
            .elements = elements_of(element_order),
            .material = linear_material(material.poisson),
            .mesh = text_of(divisions),
            .h_m = width_in / divisions[1] * 0.0254,
            .dofs = solution.space->dofs(),
            .value = solution.work_of_load_j(),
            .reference = in_plane ? 0.005424 : 0.001754,
            .unit = "in",
            .source = "R. MacNeal, R. Harder, Finite Elements in Analysis and Design 1 (1985) 3-20, Table 7",
            .note = note};
}

}  // namespace

VerificationRows twisted_beam_rows(const Effort& effort)
{
    VerificationRows rows;
    for (const Vec3& load : {Vec3(0, 0, 1), Vec3(0, 1, 0)}) {
        rows.push_back(row_of(effort, load, 1, {48, 8, 4}));
        rows.push_back(row_of(effort, load, 2, {24, 4, 2}));
        bound_by_grade_a(rows.back());
        if (!effort.full) continue;
        rows.push_back(row_of(effort, load, 2, {48, 8, 4}));
        bound_by_grade_a(rows.back());
    }
    return rows;
}

}  // namespace reference_fem
