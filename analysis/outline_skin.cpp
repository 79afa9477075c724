#include "analysis/outline_skin.hpp"

#include <algorithm>

namespace analysis {
namespace {

using pbs::Vec3;

struct Crossing {
    Vec3 point;
    bool is_chosen;  // the nearer vertex of its edge
};

std::vector<Crossing> crossings_of(const Plane& plane, const pbs::Positions& positions, const pbs::Triangles& skin,
                                   const std::vector<bool>& chosen)
{
    const Eigen::VectorXd height = (positions.rowwise() - plane.point.transpose()) * plane.normal;
    std::vector<Crossing> crossings;
    for (Eigen::Index t = 0; t < skin.rows(); ++t)
        for (int corner = 0; corner < 3; ++corner) {
            const int a = skin(t, corner), b = skin(t, (corner + 1) % 3);
            if (a > b || (height(a) >= 0.0) == (height(b) >= 0.0)) continue;  // the neighbouring triangle has the edge from b to a
            const double share = height(a) / (height(a) - height(b));
            crossings.push_back({positions.row(a) + share * (positions.row(b) - positions.row(a)), chosen[share < 0.5 ? a : b]});
        }
    return crossings;
}

bool is_on_chosen(const std::vector<Crossing>& crossings, const Vec3& point)
{
    const auto nearest = std::min_element(crossings.begin(), crossings.end(), [&](const Crossing& a, const Crossing& b) {
        return (a.point - point).squaredNorm() < (b.point - point).squaredNorm();
    });
    return nearest != crossings.end() && nearest->is_chosen;
}

}  // namespace

double share_of_outline(const pbs::Positions& outline, const Plane& plane, const pbs::Positions& positions, const pbs::Triangles& skin,
                        const std::vector<bool>& chosen)
{
    const std::vector<Crossing> crossings = crossings_of(plane, positions, skin, chosen);
    double own = 0.0, all = 0.0;
    for (Eigen::Index i = 0; i < outline.rows(); ++i) {
        const Vec3 before = outline.row((i + outline.rows() - 1) % outline.rows()), point = outline.row(i),
                   after = outline.row((i + 1) % outline.rows());
        const double length = 0.5 * ((point - before).norm() + (after - point).norm());
        all += length;
        if (is_on_chosen(crossings, point)) own += length;
    }
    return all > 0.0 ? own / all : 1.0;
}

}  // namespace analysis
