// Repairs of a rig's meshes that move no point: weights that are no numbers, second sides of shells, and points without
// a triangle.
#include "experiments/rigs/rig_reader.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace pbs {
namespace {

constexpr int points_per_bad_one = 100;  // at least: of more bad ones the neighbours say nothing
// The square of the length of a shell's edges of one triangle, over its area: 4 pi for a disc, 0 for a closed body, and
// below 1 for a body with openings for its eyes and its neck.
constexpr double most_open = 1.0;

// 14,293
std::string grouped(std::size_t number)
{
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, ",");
    return text;
}

std::string count_of(std::size_t part, std::size_t whole)
{
    return grouped(part) + " of " + grouped(whole);
}

bool has_numbers(const std::vector<JointShare>& shares)
{
    return std::ranges::all_of(shares, [](const JointShare& share) { return std::isfinite(share.weight); });
}

// The first point at the place of each point, #P.
std::vector<int> first_at_place(const Positions& points)
{
    std::map<std::array<double, 3>, int> first;
    std::vector<int> place;
    for (int p = 0; p < points.rows(); ++p)
        place.push_back(first.try_emplace({points(p, 0), points(p, 1), points(p, 2)}, p).first->second);
    return place;
}

// The places of a mesh whose weights are known, and how they become those of their neighbours.
class WeightsByPlace {
public:
    WeightsByPlace(const std::vector<std::vector<JointShare>>& points, const RigMesh& mesh)
        : place_(first_at_place(mesh.points))
    {
        for (std::size_t p = 0; p < points.size(); ++p)
            if (has_numbers(points[p])) known_.try_emplace(place_[p], points[p]);
        for (const auto& triangle : mesh.triangles.rowwise())
            for (const int a : triangle)
                for (const int b : triangle)
                    if (place_[a] != place_[b] && !known_.contains(place_[a])) neighbours_[place_[a]].insert(place_[b]);
    }

    // From the known places inward, a ring of places at a time.
    void spread()
    {
        for (std::size_t before = 0; before != known_.size();) {
            before = known_.size();
            std::map<int, std::vector<JointShare>> ring;
            for (const auto& [place, around] : neighbours_)
                if (!known_.contains(place)) add_mean(place, around, ring);
            known_.merge(ring);
        }
    }

    const std::vector<JointShare>* at(std::size_t point) const
    {
        const auto found = known_.find(place_[point]);
        return found == known_.end() ? nullptr : &found->second;
    }

private:
    void add_mean(int place, const std::set<int>& around, std::map<int, std::vector<JointShare>>& ring) const
    {
        std::map<int, double> sum;  // by joint
        double total = 0.0;
        for (const int neighbour : around)
            if (const auto known = known_.find(neighbour); known != known_.end())
                for (const JointShare& share : known->second) {
                    sum[share.joint] += share.weight;
                    total += share.weight;
                }
        if (!(total > 0.0)) return;
        for (const auto& [joint, weight] : sum) ring[place].push_back({joint, weight / total});
    }

    std::vector<int> place_;
    std::map<int, std::vector<JointShare>> known_;
    std::map<int, std::set<int>> neighbours_;  // of the places that are not known
};

// A triangle of a surface whose corners are joined, with those that run round it in either direction.
struct TwoSided {
    std::array<int, 3> corners;            // ascending
    std::array<std::vector<int>, 2> side;  // the triangles in this order of the corners, and in the reverse order

    std::array<std::pair<int, int>, 3> edges() const
    {
        return {std::pair(corners[0], corners[1]), std::pair(corners[1], corners[2]),
                std::pair(corners[0], corners[2])};
    }

    bool is_doubled() const { return side[0].size() == 1 && side[1].size() == 1; }
    bool is_single() const { return side[0].size() + side[1].size() == 1; }
};

// The shells of a surface, joined at edges of two triangles, and which side of each triangle faces outward.
class Shells {
public:
    Shells(const Positions& points, const Triangles& triangles) : points_(points), triangles_(triangles)
    {
        const Triangles joined = joined_triangles(points, triangles);
        std::map<std::array<int, 3>, std::size_t> number;
        for (int f = 0; f < joined.rows(); ++f) {
            std::array<int, 3> corners = {joined(f, 0), joined(f, 1), joined(f, 2)};
            std::ranges::rotate(corners, std::ranges::min_element(corners));
            const bool is_reversed = corners[1] > corners[2];
            if (is_reversed) std::swap(corners[1], corners[2]);
            if (corners[0] == corners[1] || corners[1] == corners[2]) continue;
            const auto [found, is_new] = number.try_emplace(corners, faces_.size());
            if (is_new) faces_.push_back({corners, {}});
            faces_[found->second].side[is_reversed].push_back(f);
        }
    }

    // Of each triangle whether it is on the second side of a nearly closed shell, all of which or a part of which has
    // two sides, #F.
    std::vector<bool> second_sides()
    {
        std::vector<bool> is_second(static_cast<std::size_t>(triangles_.rows()));
        if (std::ranges::none_of(faces_, &TwoSided::is_doubled)) return is_second;
        for (std::size_t f = 0; f < faces_.size(); ++f)
            for (const auto& edge : faces_[f].edges()) at_edge_[edge].push_back(f);
        facing_.assign(faces_.size(), -1);
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            if (facing_[f] >= 0) continue;
            const std::vector<std::size_t> shell = shell_from(f);
            const auto is_known = [&](std::size_t face) {
                return faces_[face].is_doubled() || faces_[face].is_single();
            };
            if (!std::ranges::all_of(shell, is_known) || !is_nearly_closed(shell)) continue;
            const int inner = is_outward(shell) ? 1 : 0;
            for (const std::size_t face : shell)
                if (faces_[face].is_doubled()) is_second[faces_[face].side[facing_[face] ^ inner].front()] = true;
        }
        return is_second;
    }

private:
    // Whether this side of the face runs along its edge from the smaller vertex to the larger one.
    static bool runs_forward(int edge, int side) { return (edge == 2) == (side == 1); }

    // The faces of a shell, each of which gets the side that faces as that of the first one does.
    std::vector<std::size_t> shell_from(std::size_t first)
    {
        std::vector<std::size_t> shell = {first};
        facing_[first] = 0;
        for (std::size_t next = 0; next < shell.size(); ++next) {
            const std::size_t own = shell[next];
            for (int edge = 0; edge < 3; ++edge) {
                const std::pair<int, int> ends = faces_[own].edges()[edge];
                const std::vector<std::size_t>& faces = at_edge_.at(ends);
                if (faces.size() != 2) continue;
                const std::size_t other = faces[0] == own ? faces[1] : faces[0];
                if (facing_[other] >= 0) continue;
                const auto others = faces_[other].edges();
                const int at = static_cast<int>(std::ranges::find(others, ends) - others.begin());
                facing_[other] = runs_forward(at, 0) != runs_forward(edge, facing_[own]) ? 0 : 1;
                shell.push_back(other);
            }
        }
        return shell;
    }

    bool is_nearly_closed(const std::vector<std::size_t>& shell) const
    {
        double area = 0.0, open = 0.0;
        for (const std::size_t f : shell) {
            const auto& [a, b, c] = faces_[f].corners;
            area += triangle_area(points_.row(a), points_.row(b), points_.row(c));
            for (const auto& edge : faces_[f].edges())
                if (at_edge_.at(edge).size() != 2) open += (points_.row(edge.first) - points_.row(edge.second)).norm();
        }
        return open * open <= most_open * area;
    }

    // Whether the sides that face as the first one does are the first sides: those of most triangles that have one side
    // alone. Where all have two, they are those that enclose a volume and are not inside out.
    bool is_outward(const std::vector<std::size_t>& shell) const
    {
        long as_first = 0;
        Triangles facing(static_cast<Eigen::Index>(shell.size()), 3);
        for (std::size_t f = 0; f < shell.size(); ++f) {
            const TwoSided& face = faces_[shell[f]];
            const int side = facing_[shell[f]];
            if (face.is_single()) as_first += face.side[side].empty() ? -1 : 1;
            facing.row(static_cast<Eigen::Index>(f)) << face.corners[0], face.corners[1 + side], face.corners[2 - side];
        }
        return as_first != 0 ? as_first > 0 : fan_volume(points_, facing) >= 0.0;
    }

    const Positions& points_;
    const Triangles& triangles_;
    std::vector<TwoSided> faces_;
    std::map<std::pair<int, int>, std::vector<std::size_t>> at_edge_;
    // of each face the side that faces as that of the first face of its shell, -1: in no shell yet
    std::vector<int> facing_;
};

void keep_triangles(const std::vector<int>& kept, RigMesh& mesh)
{
    if (!mesh.look.material.empty()) {
        std::vector<int> material;
        mesh.look.material.resize(static_cast<std::size_t>(mesh.triangles.rows()), -1);
        for (const int f : kept) material.push_back(mesh.look.material[static_cast<std::size_t>(f)]);
        mesh.look.material = material;
    }
    mesh.triangles = Triangles(mesh.triangles(kept, Eigen::all));
}

void keep_points(const std::vector<int>& kept, RigMesh& mesh)
{
    if (mesh.look.numbers.size() > 0) {
        mesh.look.numbers.conservativeResizeLike(
            decltype(mesh.look.numbers)::Zero(mesh.points.rows(), mesh.look.numbers.cols()));
        mesh.look.numbers = decltype(mesh.look.numbers)(mesh.look.numbers(kept, Eigen::all));
    }
    mesh.points = Positions(mesh.points(kept, Eigen::all));
    for (Positions& displacements : mesh.morphs.displacements)
        displacements = Positions(displacements(kept, Eigen::all));
    if (mesh.joints.empty()) return;
    Weights skin;
    skin.first.push_back(0);
    for (const int p : kept) {
        for (int e = mesh.skin.first[p]; e < mesh.skin.first[p + 1]; ++e)
            skin.add(mesh.skin.bone[e], mesh.skin.weight[e]);
        skin.end_vertex();
    }
    mesh.skin = std::move(skin);
}

}  // namespace

std::vector<std::vector<JointShare>> with_weights_of_neighbours(std::vector<std::vector<JointShare>> points,
                                                                const RigMesh& mesh, const std::string& file,
                                                                std::vector<std::string>& remarks)
{
    const auto bad = static_cast<std::size_t>(
        std::ranges::count_if(points, [](const auto& shares) { return !has_numbers(shares); }));
    if (bad == 0) return points;
    const std::string field = "mesh " + mesh.name + ", weights", value = count_of(bad, points.size()) + " points";
    if (points_per_bad_one * bad > points.size())
        throw InputError(file, 0, field, value,
                         "are no finite numbers: expected at most 1 %, which take the weights of their neighbours; "
                         "normalise the weights in "
                         "the program that made the model, and export it again");
    WeightsByPlace weights(points, mesh);
    weights.spread();
    for (std::size_t p = 0; p < points.size(); ++p) {
        if (has_numbers(points[p])) continue;
        const std::vector<JointShare>* const own = weights.at(p);
        if (own == nullptr)
            throw InputError(
                file, 0, field, value,
                "are no finite numbers, and point " + std::to_string(p) + " has no neighbour with weights");
        points[p] = *own;
    }
    remarks.push_back("the weights of " + value + " of mesh " + mesh.name +
                      " are no finite numbers; they take those of their neighbours");
    return points;
}

void leave_out_second_sides_and_unused_points(Rig& rig)
{
    for (RigMesh& mesh : rig.meshes) {
        const std::vector<bool> is_second = Shells(mesh.points, mesh.triangles).second_sides();
        std::vector<int> kept;
        for (int f = 0; f < static_cast<int>(is_second.size()); ++f)
            if (!is_second[f]) kept.push_back(f);
        if (kept.size() < is_second.size()) {
            rig.remarks.push_back(
                count_of(is_second.size() - kept.size(), is_second.size()) + " triangles of mesh " + mesh.name +
                " are the second side of others, with their corners in the reverse order; they are left out");
            keep_triangles(kept, mesh);
        }
        const auto points = static_cast<std::size_t>(mesh.points.rows());
        kept = renumbered(mesh.triangles, mesh.points.rows());
        if (kept.size() == points) continue;
        rig.remarks.push_back(count_of(points - kept.size(), points) + " points of mesh " + mesh.name +
                              " are left out; no triangle uses them");
        keep_points(kept, mesh);
    }
}

}  // namespace pbs
