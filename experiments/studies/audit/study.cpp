// The paper against itself: its mesh sizes, its Table 1 and its equations for the volume constraint. Writes
// DIR/audit/print/printed.csv, by which C13 to C15 are judged.

#include "analysis/records/record_files.hpp"
#include "experiments/settings/recorded_settings.hpp"
#include "experiments/studies/audit/printed_values.hpp"
#include "experiments/studies/study.hpp"
#include "pbs/constraints/volume_printed.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

namespace experiments {
namespace {

// The random tets on which the printed equations are evaluated.
struct AuditCase {
    int tets = 200;
    unsigned seed = 1;
};

RECORD_SETTINGS(AuditCase, tets, seed)

std::string audit_print(const AuditCase& audit_case, const std::string& folder)
{
    std::vector<analysis::PrintedValue> printed_values;
    for (const auto& values : {mesh_size_values(), table_1_values(), equation_values(audit_case.tets, audit_case.seed)})
        printed_values.insert(printed_values.end(), values.begin(), values.end());
    analysis::printed_table(printed_values).write(analysis::path_in(folder, "printed.csv"));
    return {};
}

StudyPlan plan(bool)
{
    return {{work_run("print", AuditCase{}, 1.0, audit_print)}, {}};
}

using Point = pbs::Vector3<double>;
using Corners = std::array<Point, 4>;
using Tet = pbs::VolumeConstraint<double>;

double value_at(const Tet& tet, const Corners& p)
{
    return value(tet, p[0], p[1], p[2], p[3]);
}

// Central differences. C is cubic, and linear in each coordinate, so that their only error is rounding.
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

// A tet with edges of about 1 m, at about 1 m from the origin, with 1.3 times its rest volume.
std::pair<Tet, Corners> random_tet(std::mt19937& random)
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

// Eq. 11-16 in double: about ten roundings of products of about 10 m^3, over a step of 1e-2 m and a gradient of about
// 0.1 m^2.
constexpr double rounding = 1e-10;

// The largest error among `tets` random tets.
template <typename Error>
double largest_error(int tets, unsigned seed, const Error& error)
{
    std::mt19937 random(seed);
    double largest = 0.0;
    for (int i = 0; i < tets; ++i) {
        const auto [tet, p] = random_tet(random);
        largest = std::max(largest, error(tet, p));
    }
    return largest;
}

}  // namespace

Study audit_study()
{
    return {"audit", plan};
}

using analysis::PrintedValue;

std::vector<PrintedValue> mesh_size_values(const std::array<TableOneRow, 5>& table)
{
    const auto of_mean = [&](const std::string& quantity, double printed, int TableOneRow::*count) {
        double mean = 0.0;
        for (const TableOneRow& row : table) mean += row.*count / static_cast<double>(table.size());
        return PrintedValue{"C13", quantity, {}, printed, 0.75 * mean, 1.25 * mean};
    };
    return {of_mean("mean_vertices", 2000.0, &TableOneRow::vertices),
            of_mean("mean_tets", 10000.0, &TableOneRow::tets)};
}

std::vector<PrintedValue> table_1_values()
{
    constexpr double half_a_digit_ms = 0.05, half_a_digit_fps = 0.05, steps_in_1_s = 100.0;
    const double infinite = std::numeric_limits<double>::infinity();
    std::vector<PrintedValue> values;
    for (const TableOneRow& row : table_1()) {
        const analysis::CaseKey key = {.model = row.model};
        values.push_back({"C14", "stretch_constraints", key, double(row.stretch), double(row.vertices + row.tets + 1),
                          double(6 * row.tets)});
        values.push_back(
            {"C14", "bind_constraints", key, double(row.bind), double(row.vertices), double(row.vertices)});
        values.push_back({"C14", "ct_total_ms", key, row.total_ms,
                          row.stretch_ms + row.volume_ms - 3.0 * half_a_digit_ms, infinite});
        values.push_back({"C14", "ct_total_of_1_s_ms", key, row.total_ms,
                          steps_in_1_s * 1e3 / (row.frames_per_s + half_a_digit_fps) - half_a_digit_ms,
                          steps_in_1_s * 1e3 / (row.frames_per_s - half_a_digit_fps) + half_a_digit_ms});
    }
    return values;
}

std::vector<PrintedValue> equation_values(int tets, unsigned seed)
{
    using pbs::Printed;
    const std::array<std::string, 4> equations = {"15-16", "12", "13", "14"};
    std::vector<PrintedValue> values;
    const auto add_gradient = [&](int corner, const std::string& reading, auto gradient) {
        const double largest = largest_error(tets, seed, [&](const Tet& tet, const Corners& p) {
            const Point quotient = difference_quotient(tet, p, corner);
            return (gradient(tet, p[0], p[1], p[2], p[3])[corner] - quotient).norm() / quotient.norm();
        });
        const analysis::CaseKey key = {
            .equation = equations[corner], .gradient_of = "p" + std::to_string(corner + 1), .reading = reading};
        values.push_back({"C15", "gradient_error", key, largest, 0.0, rounding});
    };
    for (int corner = 0; corner < 4; ++corner)
        add_gradient(corner, "as_printed",
                     [](const auto&... of) { return pbs::gradient_printed<Printed::labels_absolute>(of...); });
    for (int corner = 1; corner < 4; ++corner)
        add_gradient(corner, "relative_to_p1",
                     [](const auto&... of) { return pbs::gradient_printed<Printed::labels_relative>(of...); });
    const auto add_correction = [&](const std::string& equation, const std::string& reading, auto project) {
        const double largest = largest_error(tets, seed, [&](const Tet& tet, Corners p) {
            const double before = value_at(tet, p);
            project(tet, p[0], p[1], p[2], p[3]);
            return std::abs(value_at(tet, p) / before);
        });
        values.push_back(
            {"C15", "constraint_after_over_before", {.equation = equation, .reading = reading}, largest, 0.0, 1.0});
    };
    add_correction("17-20", "derived_gradients", [](auto&... of) { pbs::project_printed<Printed::sign>(of...); });
    add_correction("12-20", "as_printed", [](auto&... of) { pbs::project_printed<Printed::as_printed>(of...); });
    add_correction("8", "derived_gradients",
                   [](const Tet& tet, auto&... p) { pbs::project(tet, 1.0, 1.0, 1.0, 1.0, p...); });
    values.back().claim = "control_of_C15";
    return values;
}

}  // namespace experiments
