#include "reference_fem/contact/near_pairs.hpp"

#include "pbs/geometry/topology.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace reference_fem {
namespace {

using pbs::Vec3;
using Box = Eigen::AlignedBox3d;

constexpr double edge_range_share = 0.5;  // of a pair's range, for pairs of edges
constexpr double slack_in_ranges = 1.0;   // by which nodes may move before the next search
constexpr double touching_share =
    1e-6;  // of the range: pairs as near as that at rest touch, as those of the two sides of a cut do
constexpr double rounding_share =
    1e-10;  // of an edge's length: places of 1 m are rounded to 1e-14 of edges of a centimetre

Vec3 position(const pbs::Positions& rest, const Eigen::VectorXd& displacement, int node)
{
    return rest.row(node).transpose() + displacement.segment<3>(3 * node);
}

// Boxes in the order of their lower ends along one axis. A box whose place is not a number has no order, and overlaps
// none.
struct OrderedBoxes {
    static constexpr int at_once = 16;  // boxes that are compared with one

    OrderedBoxes(const std::vector<Box>& boxes, int axis)
    {
        for (std::size_t k = 0; k < boxes.size(); ++k)
            if (!std::isnan(boxes[k].min()(axis))) begin_m_and_number.push_back({boxes[k].min()(axis), k});
        std::ranges::sort(begin_m_and_number);
        ends_m.setConstant(begin_m_and_number.size() + at_once, 6, std::numeric_limits<float>::quiet_NaN());
        Eigen::Index row = 0;
        for (const auto& [begin_m, k] : begin_m_and_number)
            ends_m.row(row++) << boxes[k].min().cast<float>().transpose(), boxes[k].max().cast<float>().transpose();
    }
    std::vector<std::pair<double, int>> begin_m_and_number;  // in the list
    // Lower ones, then upper ones; at_once rows of NaN end them. Rounding keeps the order of numbers, so that no
    // overlap is lost.
    Eigen::Array<float, Eigen::Dynamic, 6> ends_m;
};

// Sweep and prune: calls `found` once for each two boxes that overlap, one of each list or two of the same list. The
// boxes are sorted along the axis on which the first list is longest. A box is compared with those that begin before
// its end, sixteen at once, so that the loop is vectorised. Boxes at the front that have all ended before its beginning
// are skipped.
template <typename Found>
void for_each_overlap(const std::vector<Box>& one, const std::vector<Box>& other, const Found& found)
{
    Box whole;
    for (const Box& box : one) whole.extend(box);
    int a = 0;
    whole.sizes().maxCoeff(&a);
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    const bool is_same_list = &one == &other;
    const OrderedBoxes first(one, a), second = is_same_list ? first : OrderedBoxes(other, a);
    const auto ends_m = [&](int column) { return second.ends_m.col(column).data(); };
    const float *x = ends_m(a), *y = ends_m(b), *z = ends_m(c), *x_end = ends_m(3 + a), *y_end = ends_m(3 + b),
                *z_end = ends_m(3 + c);
    for (std::size_t i = 0, begin = 0; i < first.begin_m_and_number.size(); ++i) {
        const Eigen::Array3f lower = first.ends_m.row(i).head<3>(), upper = first.ends_m.row(i).tail<3>();
        const float x0 = lower(a), y0 = lower(b), z0 = lower(c), x1 = upper(a), y1 = upper(b), z1 = upper(c);
        while (x_end[begin] < x0) ++begin;
        for (std::size_t j = is_same_list ? i + 1 : begin; x[j] <= x1; j += OrderedBoxes::at_once) {
            int overlaps[OrderedBoxes::at_once];
            for (std::size_t k = 0; k < OrderedBoxes::at_once; ++k)
                overlaps[k] = (x[j + k] <= x1) & (x_end[j + k] >= x0) & (y[j + k] <= y1) & (y_end[j + k] >= y0) &
                              (z[j + k] <= z1) & (z_end[j + k] >= z0);
            for (std::size_t k = 0; k < OrderedBoxes::at_once; ++k)
                if (overlaps[k]) found(first.begin_m_and_number[i].second, second.begin_m_and_number[j + k].second);
        }
    }
}

std::vector<Box> boxes_of(const auto& simplices, const std::vector<Box>& of_node)
{
    std::vector<Box> boxes;
    for (const auto& simplex : simplices) {
        boxes.push_back(of_node[simplex.front()]);
        for (const int node : simplex) boxes.back().extend(of_node[node]);
    }
    return boxes;
}

// The first simplex of a pair has this many points.
int first_points(PairKind kind)
{
    return kind == PairKind::point_triangle ? 1 : 2;
}

// The distance of a pair cannot change by more.
double relative_motion(PairKind kind, const FourPoints& motion)
{
    double squared = 0.0;
    for (int i = 0; i < first_points(kind); ++i)
        for (int j = first_points(kind); j < 4; ++j)
            squared = std::max(squared, (motion.col(i) - motion.col(j)).squaredNorm());
    return std::sqrt(squared);
}

// A lower bound of the distance: the gap along the line from the centre of the second simplex to that of the first one.
double gap_between_centres(PairKind kind, const FourPoints& points)
{
    const int n = first_points(kind);
    const Vec3 between = points.leftCols(n).rowwise().mean() - points.rightCols(4 - n).rowwise().mean();
    const Eigen::RowVector4d along = between.transpose() * points;
    const double length = between.norm();
    return length > 0.0 ? (along.head(n).minCoeff() - along.tail(4 - n).maxCoeff()) / length : 0.0;
}

// The displacements of four nodes.
FourPoints motion_of(const std::array<int, 4>& nodes, const Eigen::VectorXd& displacement)
{
    FourPoints motion;
    for (int i = 0; i < 4; ++i) motion.col(i) = displacement.segment<3>(3 * nodes[i]);
    return motion;
}

bool share_a_node(const auto& one, const auto& other)
{
    return std::ranges::any_of(one, [&](int node) { return std::ranges::find(other, node) != other.end(); });
}

// Four triangles in place of a face, over its corners and the middles of its edges.
void add_face(const std::array<int, 3>& corner, const std::map<std::pair<int, int>, int>& middles,
              ContactSurface& surface)
{
    if (middles.empty()) {
        surface.triangles.push_back(corner);
        return;
    }
    std::array<int, 3> middle;  // of the edge from corner k to the next one
    for (int k = 0; k < 3; ++k) middle[k] = middles.at(std::minmax(corner[k], corner[(k + 1) % 3]));
    for (int k = 0; k < 3; ++k) surface.triangles.push_back({corner[k], middle[k], middle[(k + 2) % 3]});
    surface.triangles.push_back(middle);
}

// Whether the segment from a to b passes through the inside of the triangle in columns 0 to 2, by more than rounding:
// the four triangles in a face of a quadratic tet lie in one plane where its edges are straight.
bool passes_through(const Vec3& a, const Vec3& b, const Eigen::Matrix3d& triangle)
{
    const Vec3 p = triangle.col(0), q = triangle.col(1), r = triangle.col(2);
    const double rounding = rounding_share * (b - a).norm() * (q - p).norm() * (r - p).norm();
    const auto side = [&](const Vec3& o, const Vec3& x, const Vec3& y, const Vec3& z) {
        const double volume = (x - o).dot((y - o).cross(z - o));
        return (volume > rounding) - (volume < -rounding);
    };
    if (side(a, p, q, r) * side(b, p, q, r) >= 0) return false;
    return std::abs(side(a, b, p, q) + side(a, b, q, r) + side(a, b, r, p)) == 3;
}

}  // namespace

ContactSurface contact_surface(const SimplexSpace& space)
{
    const TetNodes& nodes = space.tet_nodes();
    std::map<std::pair<int, int>, int> middles;
    for (Eigen::Index t = 0; space.element_order() == 2 && t < nodes.rows(); ++t)
        for (int k = 0; k < 6; ++k) {
            const auto& [a, b] = SimplexSpace::edge_corners[k];
            const int one = nodes(t, a), other = nodes(t, b);
            middles[std::minmax(one, other)] = nodes(t, 4 + k);
        }
    ContactSurface surface;
    const pbs::Triangles faces = pbs::boundary_of(nodes.leftCols<4>());
    for (const auto& face : faces.rowwise()) add_face({face(0), face(1), face(2)}, middles, surface);

    surface.node_area = Eigen::VectorXd::Zero(space.nodes());
    std::map<std::array<int, 2>, double> edges;
    for (const auto& [a, b, c] : surface.triangles) {
        const auto at = [&](int node) -> Vec3 { return space.node_positions().row(node); };
        const double third = pbs::triangle_area(at(a), at(b), at(c)) / 3.0;
        for (const int node : {a, b, c}) surface.node_area(node) += third;
        for (const auto& [one, other] : {std::array{a, b}, std::array{b, c}, std::array{c, a}})
            edges[{std::min(one, other), std::max(one, other)}] += third;
    }
    for (const auto& [edge, area] : edges) {
        surface.edges.push_back(edge);
        surface.edge_area.push_back(area);
    }
    for (int node = 0; node < space.nodes(); ++node)
        if (surface.node_area(node) > 0.0) surface.nodes.push_back(node);
    return surface;
}

NearPairs::NearPairs(const SimplexSpace& space, double range_m)
    : range_m_(range_m), rest_(space.node_positions()), surface_(contact_surface(space))
{
}

std::array<int, 4> NearPairs::nodes_of(const NearPair& pair) const
{
    if (pair.kind == PairKind::point_triangle) {
        const auto& [a, b, c] = surface_.triangles[pair.second];
        return {pair.first, a, b, c};
    }
    const auto &one = surface_.edges[pair.first], &other = surface_.edges[pair.second];
    return {one[0], one[1], other[0], other[1]};
}

FourPoints NearPairs::points_of(const std::array<int, 4>& nodes, const Eigen::VectorXd& displacement) const
{
    return at_rest(nodes) + motion_of(nodes, displacement);
}

FourPoints NearPairs::at_rest(const std::array<int, 4>& nodes) const
{
    FourPoints points;
    for (int i = 0; i < 4; ++i) points.col(i) = rest_.row(nodes[i]).transpose();
    return points;
}

// Three quick bounds come before the distance: the boxes, the gap along the line between the centres, and how far the
// points move against each other on the way.
void NearPairs::search(const Eigen::VectorXd& displacement, const Eigen::VectorXd& step) const
{
    from_ = displacement;
    step_ = step;
    const double slack_m = slack_in_ranges * range_m_, margin_m = slack_m + 0.5 * range_m_;
    std::vector<Box> of_node(rest_.rows());
    for (const int node : surface_.nodes) {
        const Vec3 from = position(rest_, displacement, node), to = from + step.segment<3>(3 * node);
        of_node[node] = Box(Vec3(from.cwiseMin(to).array() - margin_m), Vec3(from.cwiseMax(to).array() + margin_m));
    }
    near_.clear();
    const auto add = [&](NearPair pair) {
        const std::array<int, 4> nodes = nodes_of(pair);
        const FourPoints points = points_of(nodes, displacement);
        const double reach_m = range_m_ + 2.0 * slack_m + relative_motion(pair.kind, motion_of(nodes, step));
        if (gap_between_centres(pair.kind, points) > reach_m) return;
        pair.distance_m = closest_points(pair.kind, points).distance_m;
        if (pair.distance_m > reach_m) return;
        pair.range_m = std::min(range_m_, 0.5 * closest_points(pair.kind, at_rest(nodes)).distance_m);
        if (pair.kind == PairKind::edge_edge) pair.range_m *= edge_range_share;
        if (pair.range_m > touching_share * range_m_) near_.push_back(pair);
    };
    std::vector<Box> node_boxes;
    for (const int node : surface_.nodes) node_boxes.push_back(of_node[node]);
    for_each_overlap(node_boxes, boxes_of(surface_.triangles, of_node), [&](int k, int triangle) {
        const std::array<int, 1> node{surface_.nodes[k]};
        if (!share_a_node(node, surface_.triangles[triangle])) add({PairKind::point_triangle, node[0], triangle});
    });
    const std::vector<Box> edge_boxes = boxes_of(surface_.edges, of_node);
    for_each_overlap(edge_boxes, edge_boxes, [&](int one, int other) {
        if (!share_a_node(surface_.edges[one], surface_.edges[other]))
            add({PairKind::edge_edge, std::min(one, other), std::max(one, other)});
    });
    std::ranges::sort(near_, {}, [](const NearPair& pair) { return std::tuple(pair.kind, pair.first, pair.second); });
}

// The pairs of the last search are all that can press where each node is within the slack of one place on its way.
bool NearPairs::is_covered(const Eigen::VectorXd& displacement) const
{
    if (from_.size() == 0) return false;
    const double squared = step_.squaredNorm(), along = step_.dot(displacement - from_);
    const double share = squared > 0.0 ? std::clamp(along / squared, 0.0, 1.0) : 0.0;
    const double slack_m = slack_in_ranges * range_m_;
    return std::ranges::all_of(surface_.nodes, [&](int node) {
        const Vec3 off =
            displacement.segment<3>(3 * node) - from_.segment<3>(3 * node) - share * step_.segment<3>(3 * node);
        return off.squaredNorm() <= slack_m * slack_m;
    });
}

const std::vector<NearPair>& NearPairs::at(const Eigen::VectorXd& displacement) const
{
    if (!is_covered(displacement)) search(displacement, Eigen::VectorXd::Zero(rest_.size()));
    return near_;
}

bool NearPairs::may_be_within(const NearPair& pair, const std::array<int, 4>& nodes,
                              const Eigen::VectorXd& displacement, double distance_m) const
{
    return pair.distance_m - relative_motion(pair.kind, motion_of(nodes, displacement) - motion_of(nodes, from_)) <
           distance_m;
}

// The longest step for which every pair keeps a tenth of its distance.
double NearPairs::largest_step(const Eigen::VectorXd& displacement, const Eigen::VectorXd& step) const
{
    if (!step.allFinite()) return 0.0;
    if (!is_covered(displacement) || !is_covered(displacement + step)) search(displacement, step);
    double largest = 1.0;
    for (const NearPair& pair : near_) {
        const std::array<int, 4> nodes = nodes_of(pair);
        largest =
            std::min(largest, safe_share(pair.kind, points_of(nodes, displacement), motion_of(nodes, step), largest));
    }
    return largest;
}

bool NearPairs::intersects(const Eigen::VectorXd& displacement) const
{
    std::vector<Box> of_node(rest_.rows());
    for (const int node : surface_.nodes) of_node[node] = Box(position(rest_, displacement, node));
    bool is_found = false;
    for_each_overlap(boxes_of(surface_.edges, of_node), boxes_of(surface_.triangles, of_node), [&](int e, int t) {
        const auto& edge = surface_.edges[e];
        const auto& triangle = surface_.triangles[t];
        if (is_found || share_a_node(edge, triangle)) return;
        Eigen::Matrix3d corners;
        for (int k = 0; k < 3; ++k) corners.col(k) = position(rest_, displacement, triangle[k]);
        is_found =
            passes_through(position(rest_, displacement, edge[0]), position(rest_, displacement, edge[1]), corners);
    });
    return is_found;
}

}  // namespace reference_fem
