#include "pbs/solver/xpbd_solver.hpp"

namespace pbs {
namespace {

// The change of lambda by Eq. 18 of Macklin 2016; zero if nothing can move.
template <typename Scalar>
Scalar multiplier_step(Scalar C, Scalar compliance_per_dt2, Scalar lambda, Scalar w_gradient2)
{
    const Scalar denominator = w_gradient2 + compliance_per_dt2;
    return w_gradient2 > Scalar(0) ? (-C - compliance_per_dt2 * lambda) / denominator : Scalar(0);
}

}  // namespace

template <typename Scalar>
PlainXpbdProjection<Scalar>::PlainXpbdProjection(const XpbdConstraints& constraints)
    : w_(constraints.inverse_mass.begin(), constraints.inverse_mass.end()), x_(w_.size()), q_(w_.size())
{
    for (const auto& [bind, compliance] : constraints.bind)
        bind_.push_back({{bind.vertex, Scalar(bind.rest_distance), Scalar(1)}, Scalar(compliance), Scalar(0)});
    for (const auto& [edge, compliance] : constraints.stretch)
        stretch_.push_back({{edge.vertex, Scalar(edge.rest_length), Scalar(1)}, Scalar(compliance), Scalar(0)});
    for (const auto& [tet, compliance] : constraints.volume)
        volume_.push_back({{tet.vertex, Scalar(tet.rest_volume), Scalar(1)}, Scalar(compliance), Scalar(0)});
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::load(const Positions& p, const Positions& q, const Vec3& origin)
{
    for (std::size_t i = 0; i < x_.size(); ++i) {
        x_[i] = (p.row(i).transpose() - origin).template cast<Scalar>();
        q_[i] = (q.row(i).transpose() - origin).template cast<Scalar>();
    }
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::begin_substep(double dt_s)
{
    dt2_ = Scalar(dt_s * dt_s);
    forget_multipliers();
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::forget_multipliers()
{
    for (auto& multiplied : bind_) multiplied.multiplier = Scalar(0);
    for (auto& multiplied : stretch_) multiplied.multiplier = Scalar(0);
    for (auto& multiplied : volume_) multiplied.multiplier = Scalar(0);
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::project_bind_constraints()
{
    for (auto& [constraint, compliance, lambda] : bind_) {
        const int i = constraint.vertex;
        const Point g = gradient(constraint, x_[i], q_[i]);
        const Scalar step = multiplier_step(value(constraint, x_[i], q_[i]), compliance / dt2_, lambda, w_[i] * g.squaredNorm());
        lambda += step;
        x_[i] += w_[i] * step * g;
    }
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::project_stretch_constraints()
{
    for (auto& [constraint, compliance, lambda] : stretch_) {
        const auto [i, j] = constraint.vertex;
        const auto [g1, g2] = gradient(constraint, x_[i], x_[j]);
        const Scalar w_gradient2 = w_[i] * g1.squaredNorm() + w_[j] * g2.squaredNorm();
        const Scalar step = multiplier_step(value(constraint, x_[i], x_[j]), compliance / dt2_, lambda, w_gradient2);
        lambda += step;
        x_[i] += w_[i] * step * g1;
        x_[j] += w_[j] * step * g2;
    }
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::project_volume_constraints()
{
    for (auto& [constraint, compliance, lambda] : volume_) {
        const auto& v = constraint.vertex;
        const auto g = gradient(constraint, x_[v[0]], x_[v[1]], x_[v[2]], x_[v[3]]);
        Scalar w_gradient2 = Scalar(0);
        for (int c = 0; c < 4; ++c) w_gradient2 += w_[v[c]] * g[c].squaredNorm();
        const Scalar C = value(constraint, x_[v[0]], x_[v[1]], x_[v[2]], x_[v[3]]);
        const Scalar step = multiplier_step(C, compliance / dt2_, lambda, w_gradient2);
        lambda += step;
        for (int c = 0; c < 4; ++c) x_[v[c]] += w_[v[c]] * step * g[c];
    }
}

template <typename Scalar>
void PlainXpbdProjection<Scalar>::store(const Vec3& origin, Positions& p) const
{
    for (std::size_t i = 0; i < x_.size(); ++i) p.row(i) = x_[i].template cast<double>() + origin;
}

template class PlainXpbdProjection<float>;
template class PlainXpbdProjection<double>;

}  // namespace pbs
