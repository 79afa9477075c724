#include "experiments/studies/bench/bench_body.hpp"

#include "pbs/character/bodies.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/geometry/topology.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace experiments {
namespace {

constexpr int most_meshed_tets = 150'000, smallest_bar = 150;  // 150 vertices
constexpr double held_share = 0.025, angle_deg = 90.0;

struct Axis {
    pbs::Vec3 begin, end;  // through the middle of the bounding box, along its longest edge [m]

    double share(const pbs::Vec3& x) const { return (x - begin).dot(end - begin) / (end - begin).squaredNorm(); }
};

Axis longest_axis(const pbs::Positions& rest)
{
    const pbs::Vec3 lower = rest.colwise().minCoeff(), upper = rest.colwise().maxCoeff();
    int longest = 0;
    (upper - lower).maxCoeff(&longest);
    Axis axis{(lower + upper) / 2.0, (lower + upper) / 2.0};
    axis.begin(longest) = lower(longest);
    axis.end(longest) = upper(longest);
    return axis;
}

// The bar's meshes have 6.0 V - 21.5 V^(2/3) tets, to within 5 % from 600 to 100,000: there are fewer at the skin, whose share falls with
// the size.
int vertices_for_tets(int tets)
{
    double vertices = tets / 6.0;
    for (int i = 0; i < 30; ++i) vertices = (tets + 21.5 * std::cbrt(vertices * vertices)) / 6.0;
    return std::max(smallest_bar, static_cast<int>(vertices));
}

pbs::Skeleton two_bones(const Axis& axis)
{
    const pbs::Vec3 middle = (axis.begin + axis.end) / 2.0;
    return {{{"upper", -1, axis.begin, middle}, {"forearm", 0, middle, axis.end}}};
}

pbs::Positions twisted(const pbs::Positions& rest, const Axis& axis)
{
    const Eigen::AngleAxisd turn(angle_deg * std::numbers::pi / 180.0, (axis.end - axis.begin).normalized());
    pbs::Positions positions = rest;
    for (Eigen::Index i = 0; i < rest.rows(); ++i) {
        const pbs::Vec3 x = rest.row(i).transpose(), turned = axis.begin + turn * (x - axis.begin);
        positions.row(i) += axis.share(x) * (turned - x).transpose();
    }
    return positions;
}

}  // namespace

BenchBody make_bench_body(const std::string& name, pbs::TetMesh mesh)
{
    const Axis axis = longest_axis(mesh.rest);
    BenchBody body;
    body.character.name = name;
    body.character.skeleton = two_bones(axis);
    body.character.binding = pbs::bind_to_nearest_bone(mesh.rest, body.character.skeleton);
    body.character.weights = pbs::paper_weights(body.character.binding, body.character.skeleton);
    for (int i = 0; i < body.character.weights.vertices(); ++i) body.character.blended.push_back(body.character.weights.blended(i));
    body.twisted = twisted(mesh.rest, axis);
    body.bind_points = body.character.binding.rest_point;
    for (Eigen::Index i = 0; i < mesh.rest.rows(); ++i) body.held.push_back(axis.share(mesh.rest.row(i).transpose()) < held_share);
    body.pose = pbs::joint_sweep(body.character.skeleton, 1, (axis.end - axis.begin).normalized(), angle_deg, 2, 0.01).steps[1];
    body.edges = static_cast<int>(pbs::edges_of(mesh.tets).rows());
    body.character.mesh = std::move(mesh);
    return body;
}

BenchBody bench_bar(int vertices)
{
    return make_bench_body("bar", pbs::make_character({.body = "bar", .vertices = vertices}).mesh);
}

BenchBody bench_bar_of_tets(int tets)
{
    if (tets <= most_meshed_tets) return bench_bar(vertices_for_tets(tets));
    const pbs::TetMesh coarse = pbs::make_character({.body = "bar", .vertices = vertices_for_tets(tets / 8)}).mesh;
    return make_bench_body("bar", pbs::refine(coarse).mesh);
}

}  // namespace experiments
