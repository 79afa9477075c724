#include "pbs/solver/particles.hpp"

#include "pbs/geometry/input_error.hpp"

#include <numeric>
#include <type_traits>

namespace pbs {
namespace {

std::vector<int> integrated_vertices(const Positions& rest, const std::vector<bool>& jiggle_zone,
                                     const PbsOptions& options)
{
    std::vector<int> vertices;
    if (options.lbs_entry == LbsEntry::increment) {
        vertices.resize(rest.rows());
        std::iota(vertices.begin(), vertices.end(), 0);
        return vertices;
    }
    for (std::size_t i = 0; options.jiggle && i < jiggle_zone.size(); ++i)
        if (jiggle_zone[i]) vertices.push_back(static_cast<int>(i));
    return vertices;
}

void check_rows(const char* field, const Positions& points, Eigen::Index vertices)
{
    if (points.rows() != vertices)
        throw InputError("pbs", 0, field, std::to_string(points.rows()) + " points",
                         "expected one per vertex, " + std::to_string(vertices));
}

}  // namespace

Particles::Particles(const Positions& rest, const std::vector<bool>& jiggle_zone, const PbsOptions& options)
    : gravity_m_s2_(options.gravity_m_s2),
      by_increment_(options.lbs_entry == LbsEntry::increment),
      jiggling_(integrated_vertices(rest, jiggle_zone, options)),
      x_(rest)
{
}

void Particles::check_input(const Positions& lbs_positions, const Positions& bind_points, double dt_s) const
{
    check_rows("lbs_positions", lbs_positions, x_.rows());
    check_rows("bind_points", bind_points, x_.rows());
    if (!jiggling_.empty() && !(dt_s > 0.0))
        throw InputError("pbs", 0, "dt", std::to_string(dt_s) + " s", "expected a positive time step");
}

void Particles::predict(const Positions& lbs_positions, double dt_s)
{
    if (v_.rows() == 0 && !jiggling_.empty()) {
        v_ = Positions::Zero(jiggling_.size(), 3);  // (2)
        x_ = lbs_positions;                         // (3)
    }
    if (by_increment_) move_by_lbs_increment(lbs_positions);
    p_ = lbs_positions;
    // (6)
    for (std::size_t j = 0; j < jiggling_.size(); ++j) {
        const int i = jiggling_[j];
        v_.row(j) += gravity_m_s2_.transpose() * dt_s;  // (7)
        p_.row(i) = x_.row(i) + v_.row(j) * dt_s;       // (8)
    }                                                   // (9)
}

void Particles::move_by_lbs_increment(const Positions& lbs_positions)
{
    if (lbs_before_.rows() > 0) x_ += lbs_positions - lbs_before_;
    lbs_before_ = lbs_positions;
}

void Particles::update(double dt_s)
{
    for (std::size_t j = 0; j < jiggling_.size(); ++j)                     // (15)
        v_.row(j) = (p_.row(jiggling_[j]) - x_.row(jiggling_[j])) / dt_s;  // (16)
    x_ = p_;                                                               // (17)-(18)
}

template <typename Scalar>
Vec3 local_origin(const Positions& p)
{
    return std::is_same_v<Scalar, float> && p.rows() > 0 ? Vec3(p.colwise().mean()) : Vec3(Vec3::Zero());
}

template Vec3 local_origin<float>(const Positions&);
template Vec3 local_origin<double>(const Positions&);

}  // namespace pbs
