// Each constitutive law at one large deformation gradient: its stress is the slope of its energy and its tangent the
// slope of its stress (the error of central differences falls with the square of the step), its tangent is symmetric, a
// rotation of the whole leaves its energy alone, and at rest it is linear elasticity.
#include "reference_fem/laws/constitutive_law.hpp"
#include "reference_fem/verification/problems.hpp"

#include <Eigen/Geometry>

namespace reference_fem {
namespace {

using Eigen::Matrix3d;

const ElasticMaterial material = {1e5, 0.4};

struct Law {
    Model model;
    std::string name;
};
const std::vector<Law> laws = {{Model::linear, "linear"},
                               {Model::corotational, "corotational"},
                               {Model::stable_neo_hookean, "stable_neo_hookean"},
                               {Model::neo_hookean, "neo_hookean"},
                               {Model::st_venant_kirchhoff, "st_venant_kirchhoff"},
                               {Model::isochoric_neo_hookean, "isochoric_neo_hookean"}};

Matrix3d strained()
{
    Matrix3d stretch;
    stretch << 1.2, 0.1, -0.05, 0.02, 0.9, 0.15, 0.1, -0.1, 1.05;
    return Eigen::AngleAxisd(1.1, pbs::Vec3(1, 2, 3).normalized()).toRotationMatrix() * stretch;
}

Matrix3d direction()
{
    Matrix3d direction;
    direction << 0.3, -0.8, 0.5, 0.9, 0.1, -0.4, -0.2, 0.6, 0.7;
    return direction;
}

struct Point {
    std::unique_ptr<const ConstitutiveLaw> law;

    double energy(const Matrix3d& f) const
    {
        return energy_density(law->evaluate(f, Derivatives::none), law->lambda_pa());
    }
    Matrix3d stress(const Matrix3d& f) const
    {
        return first_piola_kirchhoff(law->evaluate(f, Derivatives::first), law->lambda_pa());
    }
    Tangent tangent_at(const Matrix3d& f) const
    {
        return tangent(law->evaluate(f, Derivatives::second), law->lambda_pa());
    }

    // Relative errors of the two slopes along `direction`, by central differences of step h.
    double energy_slope_error(double h) const
    {
        const double slope = stress(strained()).cwiseProduct(direction()).sum();
        return std::abs((energy(strained() + h * direction()) - energy(strained() - h * direction())) / (2.0 * h) -
                        slope) /
               std::abs(slope);
    }
    double stress_slope_error(double h) const
    {
        const Matrix3d along = direction();
        const Eigen::Matrix<double, 9, 1> slope =
            tangent_at(strained()) * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(along.data());
        const Matrix3d difference = (stress(strained() + h * along) - stress(strained() - h * along)) / (2.0 * h);
        return (difference - Eigen::Map<const Matrix3d>(slope.data())).norm() / slope.norm();
    }
};

VerificationRow row_of(const Law& law, const RowQuantity& quantity, double value)
{
    return row_about({"laws", {.formulation = "one_point"}, material_of(law.name, 0.4), "none", 0.0, 0}, quantity,
                     value, 0.0, "1", "closed form: calculus, theory of elasticity");
}

VerificationRow bounded(VerificationRow row, double high, const std::string& from)
{
    bound(row, 0.0, high, from);
    return row;
}

// From 1e-2 to 1e-3 the error has to fall a hundredfold; what is exact for a central difference has none to fall.
VerificationRow slope_row(const Law& law, const RowQuantity& quantity, double coarse, double fine)
{
    constexpr double rounding = 1e-10;  // of values of order 1 over steps of 1e-3, a thousand times eps
    VerificationRow row = row_of(law, quantity, fine);
    if (coarse < rounding)
        return bounded(row, rounding, "a polynomial of degree 2 has no error but rounding over the step, 1e-10");
    expect_order(row, std::log10(coarse / fine), 2.0, "order 2 of a central difference within 0.1");
    row.note = "order in the step of the difference";
    return row;
}

VerificationRows rows_of(const Effort& effort, const Law& law)
{
    const ElasticMaterial given = solver_material(effort, material);
    const Point point{constitutive_law(law.model, lame_parameters(given.young_pa, given.poisson))};
    const Tangent tangent = point.tangent_at(strained()), at_rest = point.tangent_at(Matrix3d::Identity());
    const Tangent linear =
        Point{constitutive_law(Model::linear, lame_parameters(material.young_pa, material.poisson))}.tangent_at(
            Matrix3d::Identity());
    const Matrix3d turn = Eigen::AngleAxisd(2.0, pbs::Vec3(3, -1, 2).normalized()).toRotationMatrix();
    const double energy = point.energy(strained()),
                 turned = std::abs(point.energy(turn * strained()) - energy) / energy;

    VerificationRow frame =
        row_of(law, {"energy_change_under_rotation", "change of energy under a rotation of the whole"}, turned);
    if (law.model == Model::linear)
        frame.note = "negative control: linear strain takes rotation for strain";
    else
        frame =
            bounded(frame, 1e-12, "rounding of some 100 operations on stretches of order 1, times their cancellation");
    const double asymmetry = (tangent - tangent.transpose()).norm() / tangent.norm(),
                 distance = (at_rest - linear).norm() / linear.norm();
    return {
        slope_row(law, {"stress_error", "stress against the slope of the energy"}, point.energy_slope_error(1e-2),
                  point.energy_slope_error(1e-3)),
        slope_row(law, {"tangent_error", "tangent against the slope of the stress"}, point.stress_slope_error(1e-2),
                  point.stress_slope_error(1e-3)),
        bounded(row_of(law, {"tangent_asymmetry", "asymmetry of the tangent"}, asymmetry), 1e-13,
                "rounding of a second derivative"),
        frame,
        bounded(row_of(law, {"distance_from_linear_elasticity", "distance from linear elasticity at rest"}, distance),
                1e-12, "rounding; the same Lame parameters")};
}

}  // namespace

VerificationRows laws_rows(const Effort& effort)
{
    VerificationRows rows;
    for (const Law& law : laws)
        for (const VerificationRow& row : rows_of(effort, law)) rows.push_back(row);
    return rows;
}

}  // namespace reference_fem
