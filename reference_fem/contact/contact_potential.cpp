#include "reference_fem/contact/contact_potential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace reference_fem {
namespace {

using pbs::Vec3;

constexpr double parallel_share = 1e-3;  // of |e|^2 |f|^2 at rest: |e x f|^2 below which a pair of edges is softened
constexpr double coupling_in_ranges =
    2.0;  // pairs that near have their place in the Hessian, which then changes rarely

}  // namespace

Barrier barrier(double distance_m, double range_m)
{
    if (distance_m >= range_m) return {};
    if (!(distance_m > 0.0)) return {.value = std::numeric_limits<double>::infinity()};
    const double y = distance_m / range_m, z = y - 1.0, log = std::log(y);
    return {-range_m * z * z * log, -2.0 * z * log - z * z / y, (-2.0 * log - 4.0 * z / y + z * z / (y * y)) / range_m};
}

// m(c) = 2 c/e - (c/e)^2 of c = |e x f|^2 below e, a share of |e|^2 |f|^2 at rest; else 1.
struct ContactPotential::Mollifier {
    double value = 1.0;
    FourPointGradient gradient = FourPointGradient::Zero();
    FourPointHessian hessian = FourPointHessian::Zero();
};

ContactPotential::ContactPotential(const SimplexSpace& space, const ContactOptions& options)
    : options_(options), near_(space, options.range_m), triangles_at_node_(space.nodes(), 0)
{
    require(options.range_m > 0.0 && std::isfinite(options.range_m), "contact.range_m", options.range_m,
            "expected > 0");
    require(options.stiffness_pa > 0.0 && std::isfinite(options.stiffness_pa), "contact.stiffness_pa",
            options.stiffness_pa, "expected > 0");
    for (const auto& triangle : surface().triangles)
        for (const int node : triangle) ++triangles_at_node_[node];
}

ContactPotential::Mollifier ContactPotential::mollifier(const Term& term, const FourPoints& points) const
{
    Mollifier mollifier;
    if (term.kind == PairKind::point_triangle) return mollifier;
    const FourPoints at_rest = near_.at_rest(term.nodes);
    const double limit = parallel_share * (at_rest.col(1) - at_rest.col(0)).squaredNorm() *
                         (at_rest.col(3) - at_rest.col(2)).squaredNorm();
    const EdgeCross cross = edge_cross(points);
    if (cross.squared_m4 >= limit) return mollifier;
    const double y = cross.squared_m4 / limit, first = 2.0 * (1.0 - y) / limit, second = -2.0 / (limit * limit);
    mollifier.value = y * (2.0 - y);
    mollifier.gradient = first * cross.gradient;
    mollifier.hessian = first * cross.hessian + second * cross.gradient * cross.gradient.transpose();
    return mollifier;
}

// A point that is near several triangles of a surface is pressed by it once: each triangle counts, each edge between
// two of them and each vertex with all its triangles counts against them and for them again (inclusion and exclusion).
// Terms with the same nearest place and range cancel.
void ContactPotential::add_terms_of_node(const std::vector<Term>& touched, const Eigen::VectorXd& displacement,
                                         std::vector<Term>& terms) const
{
    const std::size_t first = terms.size();
    const auto add = [&](Term term) {
        if (!(term.closest.distance_m < term.range_m)) return;
        const auto is_the_same = [&](const Term& other) {
            const auto nodes_used = [](const Term& term) {
                std::array<int, 3> used{-1, -1, -1};
                for (int i = 1; i < 4; ++i)
                    if (term.closest.weights(i) != 0.0) used[i - 1] = term.nodes[i];
                std::ranges::sort(used);
                return used;
            };
            return other.range_m == term.range_m && nodes_used(other) == nodes_used(term);
        };
        const auto same = std::find_if(terms.begin() + first, terms.end(), is_the_same);
        if (same == terms.end())
            terms.push_back(term);
        else
            same->weight_n_m += term.weight_n_m;
    };
    std::map<int, std::pair<int, double>> corners;  // of the triangles: how many have it, and their smallest range
    for (std::size_t i = 0; i < touched.size(); ++i) {
        const Term& term = touched[i];
        add(term);
        for (int k = 1; k < 4; ++k) {
            auto& [triangles, range_m] = corners.try_emplace(term.nodes[k], 0, term.range_m).first->second;
            ++triangles;
            range_m = std::min(range_m, term.range_m);
        }
        for (std::size_t j = 0; j < i; ++j) {
            std::vector<int> common;
            for (int k = 1; k < 4; ++k)
                if (std::find(touched[j].nodes.begin() + 1, touched[j].nodes.end(), term.nodes[k]) !=
                    touched[j].nodes.end())
                    common.push_back(term.nodes[k]);
            if (common.size() != 2) continue;
            const std::array<int, 4> nodes{term.nodes[0], common[0], common[1], common[1]};
            add({term.kind, nodes, closest_on_edge(near_.points_of(nodes, displacement)),
                 std::min(term.range_m, touched[j].range_m), -term.weight_n_m});
        }
    }
    for (const auto& [node, of] : corners) {
        if (of.first != triangles_at_node_[node]) continue;
        const std::array<int, 4> nodes{touched.front().nodes[0], node, node, node};
        add({PairKind::point_triangle, nodes, closest_of_two(near_.points_of(nodes, displacement)), of.second,
             touched.front().weight_n_m});
    }
    terms.erase(
        std::remove_if(terms.begin() + first, terms.end(), [](const Term& term) { return term.weight_n_m == 0.0; }),
        terms.end());
}

std::vector<ContactPotential::Term> ContactPotential::terms_at(const Eigen::VectorXd& displacement) const
{
    std::vector<Term> terms, touched;  // touched: triangles by one node
    const auto end_node = [&] {
        if (!touched.empty()) add_terms_of_node(touched, displacement, terms);
        touched.clear();
    };
    for (const NearPair& pair : near_.at(displacement)) {
        const std::array<int, 4> nodes = near_.nodes_of(pair);
        if (!touched.empty() && (pair.kind != PairKind::point_triangle || touched.front().nodes[0] != nodes[0]))
            end_node();
        if (!near_.may_be_within(pair, nodes, displacement, pair.range_m)) continue;
        const ClosestPoints closest = closest_points(pair.kind, near_.points_of(nodes, displacement));
        if (!(closest.distance_m < pair.range_m)) continue;
        const bool is_edge = pair.kind == PairKind::edge_edge;
        const double area = is_edge ? (surface().edge_area[pair.first] + surface().edge_area[pair.second]) / 2.0
                                    : surface().node_area(pair.first);
        (is_edge ? terms : touched)
            .push_back({pair.kind, nodes, closest, pair.range_m, options_.stiffness_pa / 2.0 * area});
    }
    end_node();
    return terms;
}

double ContactPotential::value(const Eigen::VectorXd& displacement) const
{
    return state(displacement).energy_j;
}

ContactState ContactPotential::state(const Eigen::VectorXd& displacement) const
{
    ContactState state;
    for (const Term& term : terms_at(displacement)) {
        const double distance_m = term.closest.distance_m;
        state.smallest_distance_m = state.pairs == 0 ? distance_m : std::min(state.smallest_distance_m, distance_m);
        ++state.pairs;
        if (distance_m == 0.0) {
            state.energy_j = std::numeric_limits<double>::infinity();
            break;
        }
        state.energy_j += term.weight_n_m * mollifier(term, near_.points_of(term.nodes, displacement)).value *
                          barrier(distance_m, term.range_m).value;
    }
    return state;
}

std::vector<PressedPair> ContactPotential::pressed(const Eigen::VectorXd& displacement) const
{
    std::vector<PressedPair> pairs;
    for (const Term& term : terms_at(displacement)) {
        if (term.kind != PairKind::point_triangle || term.weight_n_m < 0.0) continue;
        const FourPoints at_rest = near_.at_rest(term.nodes);
        const Vec3 across = at_rest * term.closest.weights;  // from the place to the node
        pairs.push_back({at_rest.col(0) - across / 2.0, across.norm()});
    }
    return pairs;
}

void ContactPotential::add_gradient(const Eigen::VectorXd& displacement, Eigen::VectorXd& gradient) const
{
    for (const Term& term : terms_at(displacement)) {
        const Mollifier soft = mollifier(term, near_.points_of(term.nodes, displacement));
        const Barrier b = barrier(term.closest.distance_m, term.range_m);
        const FourPointGradient force =
            term.weight_n_m * (soft.value * b.first * distance_gradient(term.closest) + b.value * soft.gradient);
        for (int i = 0; i < 4; ++i) gradient.segment<3>(3 * term.nodes[i]) += force.segment<3>(3 * i);
    }
}

// Projected: the barrier's own curvature along the distance, which is never negative, of the terms that press.
void ContactPotential::add_hessian(const Eigen::VectorXd& displacement, Definiteness definiteness,
                                   NodalMatrix& hessian) const
{
    for (const Term& term : terms_at(displacement)) {
        const FourPoints points = near_.points_of(term.nodes, displacement);
        const Mollifier soft = mollifier(term, points);
        const Barrier b = barrier(term.closest.distance_m, term.range_m);
        const FourPointGradient g = distance_gradient(term.closest);
        FourPointHessian h = soft.value * b.second * g * g.transpose();
        if (definiteness == Definiteness::projected) {
            if (term.weight_n_m < 0.0) continue;
        } else {
            h += soft.value * b.first * distance_hessian(term.closest, points) + b.value * soft.hessian +
                 b.first * (g * soft.gradient.transpose() + soft.gradient * g.transpose());
        }
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) {
                const Eigen::Matrix3d block = term.weight_n_m * h.block<3, 3>(3 * i, 3 * j);
                if (!block.isZero(0.0)) hessian.add_block(term.nodes[i], term.nodes[j], block);
            }
    }
}

std::vector<NodePair> ContactPotential::couplings(const Eigen::VectorXd& displacement) const
{
    std::vector<NodePair> pairs;
    for (const NearPair& pair : near_.at(displacement)) {
        const std::array<int, 4> nodes = near_.nodes_of(pair);
        const double coupled_m = coupling_in_ranges * pair.range_m;
        if (near_.may_be_within(pair, nodes, displacement, coupled_m) &&
            closest_points(pair.kind, near_.points_of(nodes, displacement)).distance_m < coupled_m)
            for (const int node : nodes)
                for (const int other : nodes)
                    if (node != other) pairs.push_back({node, other});
    }
    return pairs;
}

}  // namespace reference_fem
