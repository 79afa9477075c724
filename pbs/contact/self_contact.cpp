#include "pbs/contact/self_contact.hpp"

#include "pbs/geometry/topology.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <bit>
#include <numeric>
#include <set>
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

template <typename Box, typename Boxes>
void put(const Box& box, Boxes& boxes, int lane)
{
    for (int axis = 0; axis < 3; ++axis) {
        boxes.low[axis][lane] = box.low[axis];
        boxes.high[axis][lane] = box.high[axis];
    }
}

// Calls `visit` with the place of each bit, the lowest first.
template <typename Visit>
void for_each_bit(unsigned bits, const Visit& visit)
{
    for (; bits != 0; bits &= bits - 1) visit(std::countr_zero(bits));
}

}  // namespace

RestSkin::RestSkin(const TetMesh& mesh)
    : rest_(mesh.rest), triangles_(boundary_of(mesh.tets)), near_(mesh.rest.rows(), -1)
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
                if (distance2 < least) {
                    least = distance2;
                    skin_vertex = v;
                }
            }
    }
    return skin_vertex;
}

Vec3 RestSkin::nearest(const Vec3& point, const Eigen::Vector4i& near) const
{
    int start = near_[near(0)];
    for (const int v : near)
        if ((rest_.row(near_[v]).transpose() - point).squaredNorm() <
            (rest_.row(start).transpose() - point).squaredNorm())
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

PointSets::PointSets(const Positions& points, const std::vector<int>& members, int most_in_a_set)
    : first{0}, member(members)
{
    // a stack: the front of the points comes first
    std::vector<std::pair<int, int>> open = {{0, static_cast<int>(member.size())}};
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
      groups_(mesh.rest, skin_.vertices(), at_once),
      blocks_(centroids(mesh), numbers_below(mesh.tets.rows()), at_once),
      points_(mesh.rest.rows()),
      first_of_block_{0},
      corners_(blocks_.sets()),
      vertex_boxes_(groups_.sets()),
      inside_(groups_.member.size()),
      tets_around_(inside_.size())
{
    Boxes none;
    Kernels::find_points(nullptr, nullptr, nullptr, none);
    // lanes without a group stay NaN and meet no box
    group_boxes_.assign((groups_.sets() + at_once - 1) / at_once, none);
    cluster_boxes_.assign((group_boxes_.size() + at_once - 1) / at_once, none);
    for (const int row : place) offset_.push_back(stride * row);
    for (const int v : groups_.member) of_group_.push_back(4 * v);
    for (int b = 0; b < blocks_.sets(); ++b) {
        std::set<std::uint32_t> vertices;
        for (int lane = 0; lane < at_once; ++lane) {
            const int k = blocks_.first[b] + lane,
                      tet = blocks_.member[k < blocks_.first[b + 1] ? k : blocks_.first[b]];
            for (int i = 0; i < 4; ++i) vertices.insert(corners_[b].offset[i][lane] = 4 * mesh.tets(tet, i));
        }
        for (const std::uint32_t offset : vertices) of_block_.push_back(offset);
        first_of_block_.push_back(static_cast<int>(of_block_.size()));
    }
}

template <typename Scalar>
void SelfContact<Scalar>::find_hits()
{
    for (int g = 0; g < groups_.sets(); ++g) {
        const std::uint32_t* offsets = of_group_.data();
        Kernels::find_points(offsets + groups_.first[g], offsets + groups_.first[g + 1], points_.data()->x,
                             vertex_boxes_[g]);
        put(Kernels::box_around(vertex_boxes_[g]), group_boxes_[g / at_once], g % at_once);
    }
    for (int c = 0; c < static_cast<int>(group_boxes_.size()); ++c)
        put(Kernels::box_around(group_boxes_[c]), cluster_boxes_[c / at_once], c % at_once);
    hits_.clear();
    for (int b = 0; b < blocks_.sets(); ++b) find_in_block(b);
    std::sort(hits_.begin(), hits_.end(),
              [](const Hit& a, const Hit& b) { return std::pair(a.vertex, a.tet) < std::pair(b.vertex, b.tet); });
}

template <typename Scalar>
void SelfContact<Scalar>::find(const Scalar* x)
{
    for (std::size_t v = 0; v < points_.size(); ++v) std::copy_n(x + offset_[v], 3, points_[v].x);
    find_hits();
    const std::vector<DepthConstraint<Scalar>> before = std::exchange(constraints_, {});
    for (const Hit& hit : hits_) add_constraint(hit);
    const auto by_vertex = [](const auto& a, const auto& b) { return a.vertex[0] < b.vertex[0]; };
    const auto found = static_cast<std::ptrdiff_t>(constraints_.size());
    for (const DepthConstraint<Scalar>& old : before)
        if (!std::binary_search(constraints_.begin(), constraints_.begin() + found, old, by_vertex))
            constraints_.push_back(old);
    std::stable_sort(constraints_.begin(), constraints_.end(), by_vertex);
}

template <typename Scalar>
void SelfContact<Scalar>::find_in_block(int block)
{
    const Scalar* x = points_.data()->x;
    const Box box =
        Kernels::box_of(of_block_.data() + first_of_block_[block], of_block_.data() + first_of_block_[block + 1], x);
    int count = 0;
    for (std::size_t k = 0; k < cluster_boxes_.size(); ++k)
        for_each_bit(Kernels::that_meet(cluster_boxes_[k], box), [&](int cluster) {
            const int c = at_once * static_cast<int>(k) + cluster;
            for_each_bit(Kernels::that_meet(group_boxes_[c], box), [&](int group) {
                const int g = at_once * c + group;
                for_each_bit(Kernels::that_meet(vertex_boxes_[g], box),
                             [&](int vertex) { inside_[count++] = of_group_[groups_.first[g] + vertex]; });
            });
        });
    if (count == 0) return;
    typename Kernels::Coordinates coordinates;
    Kernels::find_coordinates(corners_[block], x, coordinates);
    Kernels::find_tets_around(coordinates, corners_[block], inside_.data(), inside_.data() + count, x,
                              tets_around_.data());
    const int first = blocks_.first[block];
    const unsigned tets = (1U << (blocks_.first[block + 1] - first)) - 1;
    for (int i = 0; i < count; ++i)
        for_each_bit(tets_around_[i] & tets, [&](int tet) {
            hits_.push_back({static_cast<int>(inside_[i] / 4), blocks_.member[first + tet]});
        });
}

template <typename Scalar>
void SelfContact<Scalar>::add_constraint(const Hit& hit)
{
    constexpr double most_strain = 10.0, least_depth = 1e-6;  // along the way out; over half of the mean edge
    const Eigen::Vector4i tet = mesh_.tets.row(hit.tet);
    const auto at = [&](int v) -> Vec3 {
        return Eigen::Map<const Vector3<Scalar>>(points_[v].x).template cast<double>();
    };
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
std::array<Vector3<Scalar>, 5> SelfContact<Scalar>::points(const DepthConstraint<Scalar>& constraint,
                                                           const Scalar* x) const
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
