#include "experiments/studies/audit/printed_equations.hpp"

#include "pbs/constraints/volume_printed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

namespace experiments {
namespace {

using Point = pbs::Vector3<double>;
using Corners = std::array<Point, 4>;
using Tet = pbs::VolumeConstraint<double>;

double value_at(const Tet& tet, const Corners& p)
{
    return value(tet, p[0], p[1], p[2], p[3]);
}

// Central differences; C is cubic and linear in each coordinate, so that only rounding is left.
Point difference_quotient(const Tet& tet, Corners p, int corner)
{
    constexpr double step = 1e-2;
    Point gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Corners forward = p, backward = p;
        forward[corner](axis) += step;
        backward[corner](axis) -= step;
        gradient(axis) = (value_at(tet, forward) - value_at(tet, backward)) / (2.0 * step);
    }
    return gradient;
}

// Edges of some 1 m, one metre or so from the origin, 30 % off their rest volume.
struct RandomTets {
    explicit RandomTets(unsigned seed) : random(seed) {}

    std::pair<Tet, Corners> next()
    {
        std::normal_distribution<double> normal;
        Corners p;
        do {
            const Point middle(normal(random), normal(random), normal(random));
            for (Point& corner : p) corner = middle + Point(normal(random), normal(random), normal(random));
            if (value_at(Tet{}, p) < 0.0) std::swap(p[2], p[3]);
        } while (value_at(Tet{}, p) < 0.05);  // rounding of a sliver would be taken for an error
        return {Tet{{0, 1, 2, 3}, value_at(Tet{}, p) / 1.3, 1.0}, p};
    }

    std::mt19937 random;
};

// Eq. 11-16 in double: some ten roundings of products of some 10 m^3, over a step of 1e-2 m and a gradient of some 0.1 m^2.
constexpr double rounding = 1e-10;

template <typename Gradient>
analysis::PrintedFigure gradient_figure(const std::string& what, int corner, int tets, unsigned seed, Gradient gradient)
{
    RandomTets random(seed);
    double largest = 0.0;
    for (int i = 0; i < tets; ++i) {
        const auto [tet, p] = random.next();
        const Point quotient = difference_quotient(tet, p, corner);
        largest = std::max(largest, (gradient(tet, p)[corner] - quotient).norm() / quotient.norm());
    }
    return {"C15", what, largest, 0.0, rounding};
}

template <typename Projection>
analysis::PrintedFigure correction_figure(const std::string& what, int tets, unsigned seed, Projection project)
{
    RandomTets random(seed);
    double largest = 0.0;
    for (int i = 0; i < tets; ++i) {
        auto [tet, p] = random.next();
        const double before = value_at(tet, p);
        project(tet, p);
        largest = std::max(largest, std::abs(value_at(tet, p) / before));
    }
    return {"C15", what, largest, 0.0, 1.0};
}

template <pbs::Printed form>
auto printed_gradient()
{
    return [](const Tet& tet, const Corners& p) { return pbs::gradient_printed<form>(tet, p[0], p[1], p[2], p[3]); };
}

template <pbs::Printed form>
auto printed_projection()
{
    return [](const Tet& tet, Corners& p) { pbs::project_printed<form>(tet, p[0], p[1], p[2], p[3]); };
}

}  // namespace

std::vector<analysis::PrintedFigure> equation_figures(int tets, unsigned seed)
{
    using pbs::Printed;
    const std::array<std::string, 4> equations = {"Eq. 15-16", "Eq. 12", "Eq. 13", "Eq. 14"};
    std::vector<analysis::PrintedFigure> figures;
    for (int corner = 0; corner < 4; ++corner)
        figures.push_back(gradient_figure(equations[corner] + ", gradient printed for p" + std::to_string(corner + 1) + ": error", corner,
                                          tets, seed, printed_gradient<Printed::labels_absolute>()));
    for (int corner = 1; corner < 4; ++corner)
        figures.push_back(gradient_figure(equations[corner] + ", read relative to p1, for p" + std::to_string(corner + 1) + ": error",
                                          corner, tets, seed, printed_gradient<Printed::labels_relative>()));
    figures.push_back(
        correction_figure("Eq. 17-20 with the derived gradients: |C| after over before", tets, seed, printed_projection<Printed::sign>()));
    figures.push_back(
        correction_figure("Eq. 12-20 as printed: |C| after over before", tets, seed, printed_projection<Printed::as_printed>()));
    figures.push_back(correction_figure("Eq. 8 with the derived gradients (not in print): |C| after over before", tets, seed,
                                        [](const Tet& tet, Corners& p) { pbs::project(tet, 1.0, 1.0, 1.0, 1.0, p[0], p[1], p[2], p[3]); }));
    figures.back().claim = "beside C15";
    return figures;
}

}  // namespace experiments
