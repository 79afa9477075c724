#include "pbs/flesh/xpbd_neo_hookean.hpp"

#include "pbs/packed/rows.hpp"

namespace pbs {
namespace {

std::vector<XpbdVisit> in_file_order(const XpbdFlesh& flesh)
{
    std::vector<XpbdVisit> visits;
    const int tets = static_cast<int>(flesh.tets.size());
    for (int t = 0; t < tets; ++t)
        if (flesh.first_mode[t] < flesh.first_mode[t + 1]) visits.push_back({true, t});
    for (int t = 0; t < tets; ++t) visits.push_back({false, t});
    return visits;
}

double inner(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b)
{
    return a.cwiseProduct(b).sum();
}

}  // namespace

PlainXpbd::PlainXpbd(const XpbdFlesh& flesh) : PlainXpbd(flesh, in_file_order(flesh))
{
}

PlainXpbd::PlainXpbd(const XpbdFlesh& flesh, const std::vector<XpbdVisit>& visits) : flesh_(flesh), visits_(visits)
{
    for (const NeoHookeanTet& tet : flesh.tets) {
        Eigen::Matrix<double, 3, 4> g = vertex_gradients(tet, Eigen::Matrix3d::Identity());
        Eigen::Vector4d w;
        for (int i = 0; i < 4; ++i) w(i) = flesh.w(tet.vertex[i]);
        weighted_.push_back(g * w.asDiagonal() * g.transpose());
    }
    forget();
}

Rows<double> PlainXpbd::rows() const
{
    Rows<double> rows(static_cast<int>(flesh_.w.size()));
    for (int i = 0; i < rows.size(); ++i) rows[i][3] = i < flesh_.w.size() ? flesh_.w(i) : 1.0;
    return rows;
}

void PlainXpbd::load(const Positions& x, Rows<double>& rows) const
{
    load_rows(x, rows);
}

void PlainXpbd::store(const Rows<double>& rows, Positions& x) const
{
    store_rows(rows, flesh_.w.size(), x);
}

void PlainXpbd::forget()
{
    state_.assign(flesh_.tets.size(), State());
    mode_multipliers_.setZero(static_cast<Eigen::Index>(flesh_.hold.modes().size()), 3);
}

void PlainXpbd::iterate(Rows<double>& x, bool with_residual)
{
    for (const XpbdVisit& visit : visits_) {
        if (visit.is_hold)
            visit_hold(visit.tet, x);
        else
            visit_tet(visit.tet, x, with_residual);
    }
}

// C = v^T x - d; k C + lambda = 0 with the stiffness k, for x, y and z.
void PlainXpbd::visit_hold(int t, Rows<double>& x)
{
    const auto& vertex = flesh_.tets[t].vertex;
    for (int r = flesh_.first_mode[t]; r < flesh_.first_mode[t + 1]; ++r) {
        const auto& [tet, v, k] = flesh_.hold.modes()[r];
        Eigen::RowVector3d C = -targets_.row(r);
        double w_gradient2 = 0.0;
        for (int i = 0; i < 4; ++i) {
            C += v(i) * Eigen::RowVector3d::Map(x[vertex[i]]);
            w_gradient2 += flesh_.w(vertex[i]) * v(i) * v(i);
        }
        const Eigen::RowVector3d change = (-k * C - mode_multipliers_.row(r)) / (k * w_gradient2 + 1.0);
        mode_multipliers_.row(r) += change;
        for (int i = 0; i < 4; ++i) Eigen::RowVector3d::Map(x[vertex[i]]) += flesh_.w(vertex[i]) * v(i) * change;
    }
}

// The equations of xpbd_neo_hookean.hpp. All gradients have the form A g_i, with H = dC_H/dF and D = dC_D/dF for A; with
// S = sum_i w_i g_i g_i^T, sum_i w_i (A g_i) . (B g_i) = tr(A S B^T).
void PlainXpbd::visit_tet(int t, Rows<double>& x, bool with_residual)
{
    const NeoHookeanTet& tet = flesh_.tets[t];
    State& state = state_[t];
    const auto p = [&](int i) { return Vec3(Vec3::Map(x[tet.vertex[i]])); };
    const Eigen::Matrix3d F = deformation_gradient(tet, p(0), p(1), p(2), p(3));
    const Eigen::Matrix3d H = hydrostatic_gradient(F), D = deviatoric_gradient(F), HS = H * weighted_[t], DS = D * weighted_[t];
    const double k_H = flesh_.material.lambda * tet.volume, k_D = flesh_.material.mu * tet.volume;

    Eigen::Matrix3d residual = Eigen::Matrix3d::Zero();
    if (with_residual) residual = state.applied - state.multipliers(0) * H - state.multipliers(1) * D;
    const double right_H = -k_H * hydrostatic_value(F, flesh_.material.alpha) - state.multipliers(0) + k_H * inner(HS, residual);
    const double right_D = -k_D * deviatoric_value(F) - state.multipliers(1) + k_D * inner(DS, residual);
    const double HH = k_H * inner(HS, H) + 1.0, HD = k_H * inner(HS, D), DH = k_D * inner(HS, D), DD = k_D * inner(DS, D) + 1.0;
    const double determinant = HH * DD - HD * DH;  // 1 or more, by Cauchy and Schwarz
    const Eigen::Vector2d change((right_H * DD - HD * right_D) / determinant, (HH * right_D - DH * right_H) / determinant);
    state.multipliers += change;

    const Eigen::Matrix3d more = change(0) * H + change(1) * D - residual;
    state.applied += more;
    const Eigen::Matrix<double, 3, 4> force = vertex_gradients(tet, more);
    for (int i = 0; i < 4; ++i) Vec3::Map(x[tet.vertex[i]]) += flesh_.w(tet.vertex[i]) * force.col(i);
}

}  // namespace pbs
