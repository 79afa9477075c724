#include "pbs/contact/self_contact.hpp"

#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace pbs {
namespace {

double mean_edge_m(const TetMesh& mesh)
{
    double sum_m = 0.0;
    const Edges edges = edges_of(mesh.tets);
    for (const auto edge : edges.rowwise()) sum_m += (mesh.rest.row(edge(0)) - mesh.rest.row(edge(1))).norm();
    return sum_m / static_cast<double>(std::max<Eigen::Index>(edges.rows(), 1));
}

Positions centroids(const TetMesh& mesh)
{
    Positions centroids = Positions::Zero(mesh.tets.rows(), 3);
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t)
        for (const int v : mesh.tets.row(t)) centroids.row(t) += mesh.rest.row(v) / 4.0;
    return centroids;
}

std::vector<int> numbers_below(Eigen::Index count)
{
    std::vector<int> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 0);
    return numbers;
}

// The vertex of `candidates` that is farthest by `distance`, the first of equals.
template <typename Distance>
int farthest(const std::vector<int>& candidates, const Distance& distance)
{
    return *std::max_element(candidates.begin(), candidates.end(), [&](int a, int b) { return distance(a) < distance(b); });
}

template <typename Box>
bool meet(const Box& a, const Box& b)
{
    bool apart = false;
    for (int axis = 0; axis < 3; ++axis) apart |= !(a.low[axis] <= b.high[axis]) | !(b.low[axis] <= a.high[axis]);
    return !apart;
}

}  // namespace

RestSkin::RestSkin(const TetMesh& mesh) : rest_(mesh.rest), triangles_(boundary_of(mesh.tets)), near_(mesh.rest.rows(), -1)
{
    first_.assign(rest_.rows() + 1, 0);
    for (const int v : triangles_.reshaped()) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    fan_.resize(triangles_.size());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (Eigen::Index t = 0; t < triangles_.rows(); ++t)
        for (const int v : triangles_.row(t)) fan_[next[v]++] = static_cast<int>(t);
    for (int v = 0; v < rest_.rows(); ++v)
        if (first_[v + 1] > first_[v]) vertices_.push_back(near_[v] = v);
    // Breadth-first from the skin inward.
    const Adjacency edges = adjacency_of(mesh.tets, static_cast<int>(rest_.rows()));
    std::vector<int> reached = vertices_;
    for (std::size_t done = 0; done < reached.size(); ++done)
        for (int k = edges.first[reached[done]]; k < edges.first[reached[done] + 1]; ++k) {
            const int v = edges.neighbour[k];
            if (near_[v] >= 0) continue;
            near_[v] = descend(rest_.row(v), near_[reached[done]]);
            reached.push_back(v);
        }
}

int RestSkin::descend(const Vec3& point, int skin_vertex) const
{
    double least = (rest_.row(skin_vertex).transpose() - point).squaredNorm();
    for (int before = -1; before != skin_vertex;) {
        before = skin_vertex;
        for (int k = first_[before]; k < first_[before + 1]; ++k)
            for (const int v : triangles_.row(fan_[k])) {
                const double distance2 = (rest_.row(v).transpose() - point).squaredNorm();
                if (distance2 < least) least = distance2, skin_vertex = v;
            }
    }
    return skin_vertex;
}

Vec3 RestSkin::nearest(const Vec3& point, const Eigen::Vector4i& near) const
{
    int start = near_[near(0)];
    for (const int v : near)
        if ((rest_.row(near_[v]).transpose() - point).squaredNorm() < (rest_.row(start).transpose() - point).squaredNorm())
            start = near_[v];
    const int around = descend(point, start);
    Vec3 nearest = rest_.row(around);
    for (int k = first_[around]; k < first_[around + 1]; ++k) {
        const auto triangle = triangles_.row(fan_[k]);
        const Eigen::Matrix3d corners = rest_(triangle, Eigen::all);
        const Vec3 other = corners.transpose() * nearest_in_triangle(point, corners);
        if ((other - point).squaredNorm() < (nearest - point).squaredNorm()) nearest = other;
    }
    return nearest;
}

PointSets::PointSets(const Positions& points, const std::vector<int>& members, int most_in_a_set) : first{0}, member(members)
{
    std::vector<std::pair<int, int>> open = {{0, static_cast<int>(member.size())}};  // a stack: the front of the points comes first
    while (!open.empty()) {
        const auto [begin, end] = open.back();
        open.pop_back();
        if (end - begin <= most_in_a_set) {
            std::sort(member.begin() + begin, member.begin() + end);
            if (end > begin) first.push_back(end);
            continue;
        }
        const Positions inside = points(std::vector<int>(member.begin() + begin, member.begin() + end), Eigen::all);
        int axis = 0;
        (inside.colwise().maxCoeff() - inside.colwise().minCoeff()).maxCoeff(&axis);
        const auto before = [&](int a, int b) { return std::pair(points(a, axis), a) < std::pair(points(b, axis), b); };
        const int middle = begin + (end - begin) / 2;
        std::nth_element(member.begin() + begin, member.begin() + middle, member.begin() + end, before);
        open.emplace_back(middle, end);
        open.emplace_back(begin, middle);
    }
}

template <typename Scalar>
SelfContact<Scalar>::SelfContact(const TetMesh& mesh, const std::vector<int>& place, int stride)
    : mesh_(mesh),
      skin_(mesh),
      half_edge_m_(mean_edge_m(mesh) / 2.0),
      groups_(mesh.rest, skin_.vertices(), vertices_of_group),
      blocks_(centroids(mesh), numbers_below(mesh.tets.rows()), tets_of_block),
      first_of_block_{0},
      corners_(blocks_.sets()),
      box_of_block_(blocks_.sets()),
      box_of_cluster_((blocks_.sets() + blocks_of_cluster - 1) / blocks_of_cluster)
{
    for (const int row : place) offset_.push_back(stride * row);
    for (const int v : groups_.member) of_group_.push_back(offset_[v]);
    for (int b = 0; b < blocks_.sets(); ++b) {
        std::vector<int> vertices;
        for (int lane = 0; lane < tets_of_block; ++lane) {
            const int k = blocks_.first[b] + lane, tet = blocks_.member[k < blocks_.first[b + 1] ? k : blocks_.first[b]];
            for (int i = 0; i < 4; ++i) vertices.push_back(corners_[b][i][lane] = offset_[mesh.tets(tet, i)]);
        }
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        for (const int offset : vertices) of_block_.push_back(offset);
        first_of_block_.push_back(static_cast<int>(of_block_.size()));
    }
    std::vector<Eigen::AlignedBox3d> rest_boxes(blocks_.sets());
    for (int b = 0; b < blocks_.sets(); ++b)
        for (int k = blocks_.first[b]; k < blocks_.first[b + 1]; ++k)
            for (const int v : mesh.tets.row(blocks_.member[k])) rest_boxes[b].extend(mesh.rest.row(v).transpose());
    for (int g = 0; g < groups_.sets(); ++g) neighbourhoods_.push_back(neighbourhood(g, rest_boxes));
}

template <typename Scalar>
typename SelfContact<Scalar>::Neighbourhood SelfContact<Scalar>::neighbourhood(int group,
                                                                               const std::vector<Eigen::AlignedBox3d>& rest_boxes) const
{
    Eigen::AlignedBox3d around;
    for (int k = groups_.first[group]; k < groups_.first[group + 1]; ++k) around.extend(mesh_.rest.row(groups_.member[k]).transpose());
    Neighbourhood near;
    std::vector<int> vertices(groups_.member.begin() + groups_.first[group], groups_.member.begin() + groups_.first[group + 1]);
    for (int b = 0; b < blocks_.sets(); ++b) {
        if (!(rest_boxes[b].exteriorDistance(around) <= half_edge_m_)) continue;
        near.blocks.push_back(b);
        for (int k = blocks_.first[b]; k < blocks_.first[b + 1]; ++k)
            for (const int v : mesh_.tets.row(blocks_.member[k])) vertices.push_back(v);
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

    const auto X = [&](int v) -> Vec3 { return mesh_.rest.row(v); };
    const Vec3 centre = around.center();
    const int a = farthest(vertices, [&](int v) { return (X(v) - centre).norm(); });
    const int b = farthest(vertices, [&](int v) { return (X(v) - X(a)).norm(); });
    const int c = farthest(vertices, [&](int v) { return (X(v) - X(a)).cross(X(b) - X(a)).norm(); });
    const Vec3 normal = (X(b) - X(a)).cross(X(c) - X(a));
    const int d = farthest(vertices, [&](int v) { return std::abs((X(v) - X(a)).dot(normal)); });
    near.frame = {offset_[a], offset_[b], offset_[c], offset_[d]};
    near.rest_edges << X(b) - X(a), X(c) - X(a), X(d) - X(a);
    for (const int v : vertices) {
        near.offset.push_back(offset_[v]);
        for (int axis = 0; axis < 3; ++axis) near.rest[axis].push_back(Scalar(X(v)(axis) - X(a)(axis)));
    }
    return near;
}

template <typename Scalar>
typename SelfContact<Scalar>::Box SelfContact<Scalar>::box_of(const int* begin, const int* end, const Scalar* x) const
{
    constexpr Scalar far = std::numeric_limits<Scalar>::max();
    Box box{{far, far, far, 0}, {-far, -far, -far, 0}};
    for (; begin < end; ++begin)
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], x[*begin + axis]);
            box.high[axis] = std::max(box.high[axis], x[*begin + axis]);
        }
    return box;
}

template <typename Scalar>
bool SelfContact<Scalar>::is_affine(const Neighbourhood& near, const Scalar* x) const
{
    using Map = Eigen::Map<const Vector3<Scalar>>;
    const Vec3 x0 = Map(x + near.frame[0]).template cast<double>();
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = Map(x + near.frame[k + 1]).template cast<double>() - x0;
    const Eigen::Matrix<Scalar, 3, 3> inverse = (near.rest_edges * edges.inverse()).template cast<Scalar>();  // A^-1
    const Vector3<Scalar> origin = x0.template cast<Scalar>();
    const Scalar most = Scalar(half_edge_m_ * half_edge_m_ / 4.0);
    constexpr std::size_t at_once = 16;  // often a few vertices show that it is not affine
    int beyond = 0;                      // or not a number
    for (std::size_t from = 0; from < near.offset.size() && beyond == 0; from += at_once)
        for (std::size_t k = from; k < std::min(from + at_once, near.offset.size()); ++k) {
            const Scalar* p = x + near.offset[k];
            const Scalar dx = p[0] - origin(0), dy = p[1] - origin(1), dz = p[2] - origin(2);
            Scalar e2 = Scalar(0);
            for (int axis = 0; axis < 3; ++axis) {
                const Scalar e = inverse(axis, 0) * dx + inverse(axis, 1) * dy + inverse(axis, 2) * dz - near.rest[axis][k];
                e2 += e * e;
            }
            beyond += !(e2 < most);
        }
    return beyond == 0;
}

template <typename Scalar>
void SelfContact<Scalar>::find_hits(const Scalar* x)
{
    for (int b = 0; b < blocks_.sets(); ++b)
        box_of_block_[b] = box_of(of_block_.data() + first_of_block_[b], of_block_.data() + first_of_block_[b + 1], x);
    for (int c = 0; c < static_cast<int>(box_of_cluster_.size()); ++c) {
        Box& cluster = box_of_cluster_[c] = box_of_block_[c * blocks_of_cluster];
        const int end = std::min(blocks_.sets(), (c + 1) * blocks_of_cluster);
        for (int b = c * blocks_of_cluster; b < end; ++b)
            for (int axis = 0; axis < 3; ++axis) {
                cluster.low[axis] = std::min(cluster.low[axis], box_of_block_[b].low[axis]);
                cluster.high[axis] = std::max(cluster.high[axis], box_of_block_[b].high[axis]);
            }
    }
    coordinates_.assign(blocks_.sets(), std::nullopt);
    hits_.clear();
    for (int g = 0; g < groups_.sets(); ++g) {
        const Box box = box_of(of_group_.data() + groups_.first[g], of_group_.data() + groups_.first[g + 1], x);
        const Neighbourhood& near = neighbourhoods_[g];
        const bool skips_near = is_affine(near, x);
        std::size_t next_near = 0;
        for (int c = 0; c < static_cast<int>(box_of_cluster_.size()); ++c) {
            if (!meet(box, box_of_cluster_[c])) continue;
            const int end = std::min(blocks_.sets(), (c + 1) * blocks_of_cluster);
            for (int b = c * blocks_of_cluster; b < end; ++b) {
                if (!meet(box, box_of_block_[b])) continue;
                while (next_near < near.blocks.size() && near.blocks[next_near] < b) ++next_near;
                const bool is_near = next_near < near.blocks.size() && near.blocks[next_near] == b;
                if (!(is_near && skips_near)) find_in_block(g, b, x);
            }
        }
    }
    std::sort(hits_.begin(), hits_.end(),
              [](const Hit& a, const Hit& b) { return std::pair(a.vertex, a.tet) < std::pair(b.vertex, b.tet); });
}

template <typename Scalar>
void SelfContact<Scalar>::find(const Scalar* x)
{
    find_hits(x);
    const std::vector<DepthConstraint<Scalar>> before = std::exchange(constraints_, {});
    for (const Hit& hit : hits_) add_constraint(hit, x);
    const auto by_vertex = [](const auto& a, const auto& b) { return a.vertex[0] < b.vertex[0]; };
    const auto found = static_cast<std::ptrdiff_t>(constraints_.size());
    for (const DepthConstraint<Scalar>& old : before)
        if (!std::binary_search(constraints_.begin(), constraints_.begin() + found, old, by_vertex)) constraints_.push_back(old);
    std::stable_sort(constraints_.begin(), constraints_.end(), by_vertex);
}

template <typename Scalar>
typename SelfContact<Scalar>::Coordinates SelfContact<Scalar>::coordinates_in(int block, const Scalar* x) const
{
    Coordinates in;
    for (int lane = 0; lane < tets_of_block; ++lane) {
        const Scalar* p = x + corners_[block][0][lane];
        Scalar e[3][3];
        for (int k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis) e[k][axis] = x[corners_[block][k + 1][lane] + axis] - p[axis];
        for (int k = 0; k < 3; ++k) {
            const Scalar *a = e[(k + 1) % 3], *b = e[(k + 2) % 3];
            for (int axis = 0; axis < 3; ++axis)
                in.inverse[k][axis][lane] = a[(axis + 1) % 3] * b[(axis + 2) % 3] - a[(axis + 2) % 3] * b[(axis + 1) % 3];
            in.first[k][lane] = p[k];
        }
        in.volume[lane] = e[0][0] * in.inverse[0][0][lane] + e[0][1] * in.inverse[0][1][lane] + e[0][2] * in.inverse[0][2][lane];
    }
    return in;
}

// Tets with positive barycentric coordinates of a vertex that is not theirs.
template <typename Scalar>
void SelfContact<Scalar>::find_in_block(int group, int block, const Scalar* x)
{
    const Box& box = box_of_block_[block];
    for (int k = groups_.first[group]; k < groups_.first[group + 1]; ++k) {
        const Scalar* v = x + of_group_[k];
        bool is_in_box = true;
        for (int axis = 0; axis < 3; ++axis) is_in_box &= (v[axis] >= box.low[axis]) & (v[axis] <= box.high[axis]);
        if (!is_in_box) continue;
        if (!coordinates_[block]) coordinates_[block] = coordinates_in(block, x);
        const Coordinates& in = *coordinates_[block];
        int is_around[tets_of_block], any = 0;
        for (int lane = 0; lane < tets_of_block; ++lane) {
            const Scalar dx = v[0] - in.first[0][lane], dy = v[1] - in.first[1][lane], dz = v[2] - in.first[2][lane];
            Scalar beta[3];
            for (int i = 0; i < 3; ++i) beta[i] = in.inverse[i][0][lane] * dx + in.inverse[i][1][lane] * dy + in.inverse[i][2][lane] * dz;
            const Scalar first = in.volume[lane] - (beta[0] + beta[1] + beta[2]);
            is_around[lane] = (std::min(std::min(beta[0], beta[1]), std::min(beta[2], first)) >= Scalar(0)) & (in.volume[lane] > Scalar(0));
            for (const auto& corner : corners_[block]) is_around[lane] &= corner[lane] != of_group_[k];
            any |= is_around[lane];
        }
        for (int lane = 0; any != 0 && lane < blocks_.first[block + 1] - blocks_.first[block]; ++lane)
            if (is_around[lane] != 0) hits_.push_back({groups_.member[k], blocks_.member[blocks_.first[block] + lane]});
    }
}

template <typename Scalar>
void SelfContact<Scalar>::add_constraint(const Hit& hit, const Scalar* x)
{
    constexpr double most_strain = 10.0, least_depth = 1e-6;  // along the way out; over half of the mean edge
    const Eigen::Vector4i tet = mesh_.tets.row(hit.tet);
    const auto at = [&](int v) -> Vec3 { return Eigen::Map<const Vector3<Scalar>>(x + offset_[v]).template cast<double>(); };
    Eigen::Matrix3d edges, rest_edges;
    for (int k = 0; k < 3; ++k) {
        edges.col(k) = at(tet(k + 1)) - at(tet(0));
        rest_edges.col(k) = mesh_.rest.row(tet(k + 1)) - mesh_.rest.row(tet(0));
    }
    const Eigen::Matrix3d inverse = edges.inverse();
    const Vec3 beta = inverse * (at(hit.vertex) - at(tet(0)));
    const Vec3 X = mesh_.rest.row(tet(0)).transpose() + rest_edges * beta;
    if (!((mesh_.rest.row(hit.vertex).transpose() - X).norm() > half_edge_m_)) return;
    const Vec3 out = skin_.nearest(X, tet) - X;
    const double depth = out.norm();
    if (!(depth > least_depth * half_edge_m_)) return;
    const Vec3 m = (rest_edges * inverse).transpose() * out / depth;  // F^-T n
    if (!(m.norm() > 1.0 / most_strain && m.norm() < most_strain)) return;
    const Vector3<Scalar> b = beta.cast<Scalar>();
    constraints_.push_back({{hit.vertex, tet(0), tet(1), tet(2), tet(3)},
                            {Scalar(1), b(0) + b(1) + b(2) - Scalar(1), -b(0), -b(1), -b(2)},
                            m.cast<Scalar>(),
                            Scalar(depth)});
}

template <typename Scalar>
std::array<Vector3<Scalar>, 5> SelfContact<Scalar>::points(const DepthConstraint<Scalar>& constraint, const Scalar* x) const
{
    std::array<Vector3<Scalar>, 5> points;
    for (int i = 0; i < 5; ++i) points[i] = Eigen::Map<const Vector3<Scalar>>(x + offset_[constraint.vertex[i]]);
    return points;
}

template <typename Scalar>
void SelfContact<Scalar>::project(const std::vector<Scalar>& inverse_mass, Scalar* x) const
{
    for (const DepthConstraint<Scalar>& constraint : constraints_) {
        std::array<Vector3<Scalar>, 5> moved = points(constraint, x);
        std::array<Scalar, 5> w;
        for (int i = 0; i < 5; ++i) w[i] = inverse_mass[constraint.vertex[i]];
        pbs::project(constraint, w, moved);
        for (int i = 0; i < 5; ++i) Eigen::Map<Vector3<Scalar>>(x + offset_[constraint.vertex[i]]) = moved[i];
    }
}

template class SelfContact<float>;
template class SelfContact<double>;

}  // namespace pbs
