#include "analysis/metrics/closed_shells.hpp"

#include "analysis/metrics/frame_metrics.hpp"
#include "pbs/geometry/winding_number.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace analysis {
namespace {

// A closed shell that encloses less than this part of (its area)^(3/2) is a sheet: 0.09 for a sphere, 0.001 for a plate
// of 1 : 300, and some 1e-8 for the rounding of coordinates in single precision.
constexpr double least_enclosed = 1e-6;
constexpr double most_capped = 0.5;  // area of the caps over that of the shell: 0.5 for a hemisphere, 1 for a sheet
constexpr double same_place = 1e-6;  // of the surface's diagonal: coordinates in single precision

// An edge of a triangle: its points, ascending, and whether the triangle passes it from the first to the second.
struct Side {
    std::array<int, 2> points;
    int triangle;
    bool forward;
};

// Sorted by their points.
std::vector<Side> sides_of(const pbs::Triangles& triangles)
{
    std::vector<Side> sides;
    sides.reserve(static_cast<std::size_t>(3 * triangles.rows()));
    for (int f = 0; f < triangles.rows(); ++f)
        for (int k = 0; k < 3; ++k) {
            const int a = triangles(f, k), b = triangles(f, (k + 1) % 3);
            sides.push_back({{std::min(a, b), std::max(a, b)}, f, a < b});
        }
    std::ranges::stable_sort(sides, {}, &Side::points);
    return sides;
}

// Calls body(first, last) for the sides of each edge.
template <typename Body>
void for_each_edge(const std::vector<Side>& sides, Body body)
{
    for (auto first = sides.begin(); first != sides.end();) {
        const auto last =
            std::find_if(first, sides.end(), [&](const Side& side) { return side.points != first->points; });
        body(first, last);
        first = last;
    }
}

bool is_balanced(auto first, auto last)
{
    return 2 * std::count_if(first, last, [](const Side& side) { return side.forward; }) == last - first;
}

std::vector<bool> open_points(Eigen::Index points, const pbs::Triangles& triangles)
{
    std::vector<bool> is_open(static_cast<std::size_t>(points), false);
    for_each_edge(sides_of(triangles), [&](auto first, auto last) {
        if (is_balanced(first, last)) return;
        for (const int point : first->points) is_open[point] = true;
    });
    return is_open;
}

pbs::Triangles renamed(const pbs::Triangles& triangles, const std::vector<int>& joined)
{
    return triangles.unaryExpr([&](int point) { return joined[point]; });
}

// Joins the points at open edges that are nearer to each other than a rounding. They are sorted along a direction in
// which hardly two points of a surface lie at the same place.
void join_near(const pbs::Positions& points, const std::vector<bool>& is_open, std::vector<int>& joined)
{
    const double near_m = same_place * (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    const Eigen::VectorXd along = points * pbs::Vec3(0.48, 0.64, 0.6);
    std::vector<int> order;
    for (int p = 0; p < points.rows(); ++p)
        if (is_open[p]) order.push_back(p);
    std::ranges::stable_sort(order, {}, [&](int p) { return along(p); });
    pbs::Classes classes(joined.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t j = i + 1; j < order.size() && along(order[j]) - along(order[i]) <= near_m; ++j)
            if ((points.row(order[i]) - points.row(order[j])).norm() <= near_m) classes.unite(order[j], order[i]);
    for (int& point : joined) point = classes.find(point);
}

// The point that stands for each point: for a point of an open edge, one of an open edge at its place, to the bit;
// where edges are still open, one that is as near as coordinates in single precision can tell.
std::vector<int> joined_points(const pbs::Positions& points, const pbs::Triangles& triangles)
{
    std::vector<bool> is_open = open_points(points.rows(), triangles);
    std::vector<int> joined(is_open.size());
    std::iota(joined.begin(), joined.end(), 0);
    std::map<std::array<double, 3>, int> first_at;
    for (int p = 0; p < points.rows(); ++p)
        if (is_open[p])
            joined[p] = first_at.emplace(std::array{points(p, 0), points(p, 1), points(p, 2)}, p).first->second;
    is_open = open_points(points.rows(), renamed(triangles, joined));
    if (std::ranges::count(is_open, true) > 0) join_near(points, is_open, joined);
    return joined;
}

pbs::Triangles picked(const pbs::Triangles& triangles, const std::vector<int>& rows)
{
    return triangles(rows, Eigen::all);
}

// By joined points, without those that are a line or a point.
pbs::Triangles with_area(const pbs::Triangles& triangles, const std::vector<int>& joined)
{
    const pbs::Triangles corners = renamed(triangles, joined);
    std::vector<int> kept;
    for (int f = 0; f < corners.rows(); ++f)
        if (corners(f, 0) != corners(f, 1) && corners(f, 1) != corners(f, 2) && corners(f, 2) != corners(f, 0))
            kept.push_back(f);
    return picked(corners, kept);
}

void turn(pbs::Triangles& triangles, int f)
{
    std::swap(triangles(f, 1), triangles(f, 2));
}

// Turns the fewer triangles so that all face to the same side, where each edge has two triangles; returns their number.
// Nothing is turned on a surface with one side alone, nor where an edge has another number of triangles.
int orient(pbs::Triangles& triangles)
{
    const std::vector<Side> sides = sides_of(triangles);
    // the other, and: turned to it
    std::vector<std::vector<std::pair<int, bool>>> neighbours(static_cast<std::size_t>(triangles.rows()));
    bool is_manifold = true;
    for_each_edge(sides, [&](auto first, auto last) {
        is_manifold = is_manifold && last - first == 2;
        if (!is_manifold) return;
        const bool against = first->forward == std::next(first)->forward;
        neighbours[first->triangle].emplace_back(std::next(first)->triangle, against);
        neighbours[static_cast<std::size_t>(std::next(first)->triangle)].emplace_back(first->triangle, against);
    });
    if (!is_manifold) return 0;
    std::vector<int> turned(neighbours.size(), -1), pending = {0};
    turned[0] = 0;
    while (!pending.empty()) {
        const int f = pending.back();
        pending.pop_back();
        for (const auto& [other, against] : neighbours[f]) {
            const int wanted = turned[f] ^ static_cast<int>(against);
            int& of_other = turned[other];
            if (of_other >= 0 && of_other != wanted) return 0;
            if (of_other < 0) pending.push_back(other);
            of_other = wanted;
        }
    }
    const int ones = static_cast<int>(std::ranges::count(turned, 1)), fewer = 2 * ones > triangles.rows() ? 0 : 1;
    for (int f = 0; f < triangles.rows(); ++f)
        if (turned[f] == fewer) turn(triangles, f);
    return fewer == 1 ? ones : static_cast<int>(triangles.rows()) - ones;
}

// The rims of a surface whose triangles face to one side: each hole's points, in the direction in which a cap passes
// them. Empty where a point belongs to several rims, or an edge to several triangles on one side.
std::vector<std::vector<int>> rims_of(const pbs::Triangles& triangles)
{
    std::map<int, int> next;
    bool is_simple = true;
    for_each_edge(sides_of(triangles), [&](auto first, auto last) {
        if (is_balanced(first, last)) return;
        const auto& [a, b] = first->points;
        is_simple =
            is_simple && last - first == 1 && next.emplace(first->forward ? b : a, first->forward ? a : b).second;
    });
    std::vector<std::vector<int>> rims;
    while (is_simple && !next.empty()) {
        std::vector<int>& rim = rims.emplace_back();
        for (auto at = next.begin(); at != next.end(); at = next.find(rim.back())) {
            rim.push_back(at->second);
            next.erase(at);
        }
    }
    if (!is_simple) return {};
    return rims;
}

pbs::Vec3 middle_of(const pbs::Positions& points, const std::vector<int>& rim)
{
    return points(rim, Eigen::all).colwise().mean();
}

// Calls body(a, b, c) with the corners of each triangle of a cap.
template <typename Body>
void for_each_of_cap(const pbs::Positions& points, const std::vector<int>& rim, Body body)
{
    const pbs::Vec3 middle = middle_of(points, rim);
    for (std::size_t i = 0; i < rim.size(); ++i)
        body(middle, pbs::Vec3(points.row(rim[i])), pbs::Vec3(points.row(rim[(i + 1) % rim.size()])));
}

double cap_area(const pbs::Positions& points, const std::vector<int>& rim)
{
    double area_m2 = 0.0;
    for_each_of_cap(points, rim,
                    [&](const auto& a, const auto& b, const auto& c) { area_m2 += pbs::triangle_area(a, b, c); });
    return area_m2;
}

// With its caps [m^3].
double volume_of(const pbs::Positions& points, const Shell& shell)
{
    double volume_m3 = signed_volume(points, shell.triangles);
    const pbs::Vec3 origin = points.row(shell.triangles(0, 0));  // that of signed_volume
    for (const auto& rim : shell.caps)
        for_each_of_cap(points, rim, [&](const auto& a, const auto& b, const auto& c) {
            volume_m3 += pbs::tet_volume(origin, a, b, c);
        });
    return volume_m3;
}

// The largest distance of the rim's points from the best rigid motion of the rim from rest.
double distance_from_rigid(const pbs::Positions& rest, const pbs::Positions& points, const std::vector<int>& rim)
{
    const Eigen::MatrixX3d before = rest(rim, Eigen::all), after = points(rim, Eigen::all);
    const Eigen::Affine3d rigid(Eigen::umeyama(before.transpose(), after.transpose(), false));
    return ((rigid * before.transpose()).transpose() - after).rowwise().norm().maxCoeff();
}

void cap_holes(const pbs::Positions& points, Shell& shell)
{
    shell.caps = rims_of(shell.triangles);
    double caps_m2 = 0.0;
    for (const auto& rim : shell.caps) caps_m2 += cap_area(points, rim);
    if (caps_m2 >= most_capped * shell.area_m2) shell.caps.clear();
}

Shell measured_shell(const pbs::Positions& points, pbs::Triangles triangles, Holes holes)
{
    Shell shell;
    shell.area_m2 = pbs::surface_area(points, triangles);
    if (pbs::open_edge(triangles)) shell.turned = orient(triangles);
    for_each_edge(sides_of(triangles), [&](auto first, auto last) {
        if (is_balanced(first, last)) return;
        if (shell.open_edges++ == 0) shell.first_open_edge = {first->points[0], first->points[1]};
    });
    shell.triangles = std::move(triangles);
    if (shell.open_edges > 0 && holes == Holes::cap) cap_holes(points, shell);
    if (shell.open_edges > 0 && shell.caps.empty()) return shell;
    shell.volume_m3 = volume_of(points, shell);
    const bool is_flat = !(std::abs(shell.volume_m3) > least_enclosed * std::pow(shell.area_m2, 1.5));
    shell.role = is_flat ? ShellRole::flat : ShellRole::body;
    return shell;
}

// The first triangle of those with the same points, whichever way they face.
pbs::Triangles without_copies(const pbs::Triangles& triangles)
{
    std::set<std::array<int, 3>> seen;
    std::vector<int> kept;
    for (int f = 0; f < triangles.rows(); ++f) {
        std::array<int, 3> corners = {triangles(f, 0), triangles(f, 1), triangles(f, 2)};
        std::ranges::sort(corners);
        if (seen.insert(corners).second) kept.push_back(f);
    }
    return picked(triangles, kept);
}

// Copies are left out where what remains is closed: a sheet with two sides, and bodies that share a face, need theirs.
Shell shell_of(const pbs::Positions& points, const pbs::Triangles& triangles, Holes holes)
{
    const pbs::Triangles single = without_copies(triangles);
    if (single.rows() < triangles.rows())
        if (Shell shell = measured_shell(points, single, Holes::leave_open); shell.role == ShellRole::body) {
            shell.copies = static_cast<int>(triangles.rows() - single.rows());
            return shell;
        }
    return measured_shell(points, triangles, holes);
}

// Triangles that shared edges join, in the order of their first triangles.
std::vector<Shell> shells_of(const pbs::Positions& points, const pbs::Triangles& triangles, Holes holes)
{
    pbs::Classes classes(static_cast<std::size_t>(triangles.rows()));
    for_each_edge(sides_of(triangles), [&](auto first, auto last) {
        for (auto side = std::next(first); side != last; ++side) classes.unite(side->triangle, first->triangle);
    });
    std::map<int, std::size_t> place;
    std::vector<std::vector<int>> members;
    for (int f = 0; f < triangles.rows(); ++f) {
        const auto [entry, is_new] = place.emplace(classes.find(f), members.size());
        if (is_new) members.emplace_back();
        members[entry->second].push_back(f);
    }
    std::vector<Shell> shells;
    for (const std::vector<int>& rows : members) shells.push_back(shell_of(points, picked(triangles, rows), holes));
    return shells;
}

Eigen::AlignedBox3d box_of(const pbs::Positions& points, const pbs::Triangles& triangles)
{
    Eigen::AlignedBox3d box;
    for (const int point : triangles.reshaped()) box.extend(pbs::Vec3(points.row(point)));
    return box;
}

bool is_copy(const Shell& shell, const Eigen::AlignedBox3d& box, const Shell& other,
             const Eigen::AlignedBox3d& other_box)
{
    constexpr double rounding = 1e-9;  // of sums over the same triangles in another order
    const auto agree = [](double a, double b) { return std::abs(a - b) <= rounding * std::abs(b); };
    return box.min() == other_box.min() && box.max() == other_box.max() && agree(shell.area_m2, other.area_m2) &&
           agree(std::abs(shell.volume_m3), std::abs(other.volume_m3));
}

// Shells within shells, from the largest to the smallest, so that what is around a shell is known before it.
void set_roles(const pbs::Positions& points, std::vector<Shell>& shells, std::vector<int> closed)
{
    const auto size = [&](int s) { return std::abs(shells[s].volume_m3); };
    std::ranges::stable_sort(closed, std::ranges::greater(), size);
    std::vector<Eigen::AlignedBox3d> boxes;
    std::vector<bool> faces_outwards;  // of all shells, before any is turned
    for (const Shell& shell : shells) faces_outwards.push_back(shell.volume_m3 > 0.0);
    for (const int s : closed) {
        Shell& shell = shells[s];
        const Eigen::AlignedBox3d box = box_of(points, shell.triangles);
        const pbs::Vec3 within = points(shell.triangles.row(0), Eigen::all).colwise().mean();
        for (std::size_t o = boxes.size(); o-- > 0 && shell.inside < 0;) {
            const Shell& other = shells[closed[o]];
            if (is_copy(shell, box, other, boxes[o])) shell.role = ShellRole::copy;
            if (boxes[o].contains(box) && std::abs(pbs::winding_number(points, other.triangles, within)) > 0.5)
                shell.inside = closed[o];
        }
        boxes.push_back(box);
        if (shell.role == ShellRole::copy) continue;
        const bool is_in_flesh = shell.inside >= 0 && shells[shell.inside].role != ShellRole::cavity;
        // A surface that is inside out as a whole has its cavities outwards.
        if (is_in_flesh)
            shell.role = faces_outwards[s] == faces_outwards[shell.inside] ? ShellRole::nested : ShellRole::cavity;
        if (faces_outwards[s] == (shell.role != ShellRole::cavity)) continue;
        shell.turned += static_cast<int>(shell.triangles.rows());
        for (int f = 0; f < shell.triangles.rows(); ++f) turn(shell.triangles, f);
        for (auto& rim : shell.caps) std::ranges::reverse(rim);
        shell.volume_m3 = -shell.volume_m3;
    }
}

}  // namespace

ClosedShells::ClosedShells(const pbs::Positions& rest, const pbs::Triangles& triangles, Holes holes)
    : rest_(rest), joined_(joined_points(rest, triangles))
{
    shells_ = shells_of(rest, with_area(triangles, joined_), holes);
    std::vector<int> closed;
    for (int s = 0; s < static_cast<int>(shells_.size()); ++s)
        if (shells_[s].role == ShellRole::body) closed.push_back(s);
    set_roles(rest, shells_, closed);
    std::ranges::copy_if(closed, std::back_inserter(counted_),
                         [&](int s) { return shells_[s].role != ShellRole::copy; });
    Eigen::Index rows = 0;
    for (const int s : counted_) rows += shells_[s].triangles.rows();
    triangles_.resize(rows, 3);
    rows = 0;
    for (const int s : counted_) {
        const pbs::Triangles& own = shells_[s].triangles;
        triangles_.middleRows(rows, own.rows()) = own;
        rows += own.rows();
    }
}

Eigen::VectorXd ClosedShells::volumes(const pbs::Positions& points) const
{
    Eigen::VectorXd volumes(static_cast<Eigen::Index>(counted_.size()));
    for (Eigen::Index c = 0; c < volumes.size(); ++c) volumes(c) = volume_of(points, shells_[counted_[c]]);
    return volumes;
}

double ClosedShells::largest_gap_m(const pbs::Positions& points) const
{
    double largest_m = 0.0;
    for (std::size_t p = 0; p < joined_.size(); ++p)
        largest_m = std::max(largest_m, (points.row(p) - points.row(joined_[p])).norm());
    return largest_m;
}

double ClosedShells::cap_bound_m3(const pbs::Positions& points) const
{
    double bound_m3 = 0.0;
    for (const int s : counted_)
        for (const auto& rim : shells_[s].caps)
            bound_m3 += std::max(cap_area(rest_, rim), cap_area(points, rim)) * distance_from_rigid(rest_, points, rim);
    return bound_m3;
}

double ClosedShells::counted_share() const
{
    double all_m2 = 0.0, counted_m2 = 0.0;
    for (const Shell& shell : shells_) all_m2 += shell.area_m2;
    for (const int s : counted_) counted_m2 += shells_[s].area_m2;
    return all_m2 > 0.0 ? counted_m2 / all_m2 : 0.0;
}

}  // namespace analysis
