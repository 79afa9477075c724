// Flesh by XPBD with neo-Hookean constraints. In this order: the loop over steps with momentum (XpbdNeoHookean), the
// constraints and masses (XpbdFlesh), and the two implementations of one pass over the constraints: PackedXpbd, whose
// kernels are in flesh_kernels.hpp, and PlainXpbd, which has the equations of xpbd_neo_hookean.hpp in plain code.

#include "pbs/flesh/xpbd_neo_hookean.hpp"

#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/geometry/extent.hpp"
#include "pbs/geometry/input_error.hpp"
#include "pbs/packed/constraint_sequence.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

namespace pbs {

template <typename Scalar>
XpbdNeoHookean<Scalar>::XpbdNeoHookean(const TetMesh& mesh, const XpbdFlesh& flesh,
                                       const XpbdNeoHookeanOptions& options)
    : options_(options),
      system_(make_xpbd_system<Scalar>(mesh, flesh, options.packed, options.threads)),
      x_(system_->rows()),
      before_(x_),
      predicted_(x_)
{
}

template <typename Scalar>
XpbdNeoHookeanSummary XpbdNeoHookean<Scalar>::minimise(const Positions& targets, Positions& x)
{
    const bool keeps_multipliers = options_.multipliers == XpbdMultipliers::kept;
    XpbdNeoHookeanSummary summary;
    system_->set_targets(targets);
    system_->load(x, x_);
    system_->forget();
    before_ = x_;
    applied_ = Rows<Scalar>(x_.size());
    nesterov_ = 1.0;
    while (summary.iterations < options_.iterations) {
        begin_step(Scalar(momentum()), x_.size(), x_.data(), before_.data(), predicted_.data(), applied_.data());
        const int last = std::min(options_.iterations, summary.iterations + options_.iterations_per_step);
        if (!keeps_multipliers) system_->forget();
        for (; summary.iterations < last; ++summary.iterations) {
            if (options_.multipliers == XpbdMultipliers::reset) system_->forget();
            system_->iterate(x_, keeps_multipliers);
        }
        const double work = end_step(x_.size(), x_.data(), before_.data(), predicted_.data(), applied_.data());
        if (!keeps_multipliers) applied_ = Rows<Scalar>(x_.size());
        if (work < 0.0) {  // The forces point against the motion: the momentum restarts.
            nesterov_ = 1.0;
            ++summary.restarts;
        }
        ++summary.steps;
    }
    system_->store(x_, x);
    return summary;
}

// Nesterov's b = (t_k - 1) / t_{k+1} with t_{k+1} = (1 + sqrt(1 + 4 t_k^2)) / 2. The call advances k.
template <typename Scalar>
double XpbdNeoHookean<Scalar>::momentum()
{
    if (!options_.momentum) return 0.0;
    const double next = (1.0 + std::sqrt(1.0 + 4.0 * nesterov_ * nesterov_)) / 2.0;
    return (std::exchange(nesterov_, next) - 1.0) / next;
}

template class XpbdNeoHookean<float>;
template class XpbdNeoHookean<double>;

namespace {

// The gradients g_i of the barycentric coordinates of a tet's vertices, as columns [1/m].
Eigen::Matrix<double, 3, 4> shape_gradients(const NeoHookeanTet& tet)
{
    return vertex_gradients(tet, Eigen::Matrix3d::Identity());
}

// mu V |g_i|^2: what a tet adds to the stiffness of its vertices.
Eigen::Vector4d vertex_stiffness(const NeoHookeanTet& tet, const FleshMaterial& material)
{
    return material.mu * tet.volume * shape_gradients(tet).colwise().squaredNorm().transpose();
}

// The factor by which the stiffness of each vertex has to be larger in its mass, so that a visit is stable; 1 for most
// vertices, #V. stiffness: D_i, #V.
//
// A visit corrects forces at the shape before it, and so treats the curvature of its two constraints explicitly. With
// the displacement a that the tet has applied, a_{n+1} = -kappa (y_n + a_n) and x_{n+1} = y_n + a_{n+1} along an
// eigenvector of W times the curvature with the eigenvalue kappa. These shrink for kappa < (2 + 2 b) / (3 + 4 b), which
// is 4/7 for the momentum b = 1. At rest the multipliers are -mu V and mu V, and the curvature is at most
// 2 mu V |dF|^2, so that kappa <= 2 rho with rho = mu V times the largest eigenvalue of sum_i w_i g_i g_i^T.
//
// The visits of tets that share their vertices with many others damp each other. A tet that has more than 9/16 of the
// stiffness of its vertices on average is therefore treated as if it were alone. A single tet has all of the stiffness,
// and no tet of this project's bodies has more than 0.35. With the factor, kappa is at most 0.51 at the default time
// step of 0.8.
Eigen::VectorXd curvature_in_excess(const std::vector<NeoHookeanTet>& tets, const FleshMaterial& material,
                                    const Eigen::VectorXd& stiffness)
{
    constexpr double share_of_lone_tet = 4.0 * 9.0 / 16.0;  // summed over the four vertices
    constexpr double stable_rho = 0.4;                      // at a time step of 1
    Eigen::VectorXd excess = Eigen::VectorXd::Ones(stiffness.size());
    Eigen::VectorXd stiffness_of_tets = Eigen::VectorXd::Zero(stiffness.size());
    for (const NeoHookeanTet& tet : tets)
        for (int i = 0; i < 4; ++i) stiffness_of_tets(tet.vertex[i]) += vertex_stiffness(tet, material)(i);
    for (const NeoHookeanTet& tet : tets) {
        double share = 0.0;
        for (int i = 0; i < 4; ++i) share += vertex_stiffness(tet, material)(i) / stiffness_of_tets(tet.vertex[i]);
        if (share <= share_of_lone_tet) continue;
        const Eigen::Matrix<double, 3, 4> g = shape_gradients(tet);
        Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
        for (int i = 0; i < 4; ++i)
            if (stiffness(tet.vertex[i]) > 0.0) S += g.col(i) * g.col(i).transpose() / stiffness(tet.vertex[i]);
        const double rho =
            material.mu * tet.volume * Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(S).eigenvalues()(2);
        for (const int vertex : tet.vertex) excess(vertex) = std::max(excess(vertex), rho / stable_rho);
    }
    return excess;
}

}  // namespace

XpbdFlesh::XpbdFlesh(const TetMesh& mesh, const FleshEnergy& energy, const BoneHold& bones,
                     const FleshMaterial& flesh_material, double time_step)
    : material(flesh_material),
      tets(neo_hookean_tets(mesh)),
      hold(bones),
      first_mode(tets.size() + 1, 0),
      w(energy.hold())
{
    if (!(time_step > 0.0))
        throw InputError("flesh", 0, "time_step", std::to_string(time_step), "expected a value above 0");
    for (const HoldMode& mode : hold.modes()) ++first_mode[mode.tet + 1];
    for (std::size_t t = 0; t < tets.size(); ++t) first_mode[t + 1] += first_mode[t];
    size_m = diagonal_m(mesh.rest);
    for (const FleshTet& tet : energy.tets())
        for (int e = 0; e < 6; ++e)
            for (const int end : edges_of_tet[e]) w(tet.vertex[end]) += tet.w[e];
    const Eigen::VectorXd excess = curvature_in_excess(tets, material, w);
    for (Eigen::Index i = 0; i < w.size(); ++i) w(i) = w(i) > 0.0 ? time_step * time_step / (excess(i) * w(i)) : 1.0;
}

namespace {

// All springs and then all tets.
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

// The packed implementation: sixteen tets that share no vertex are visited side by side, in the order of memory of the
// solvers of Algorithm 1. In each slab of the mesh, the springs are visited first and the tets afterwards. Threads
// share the slabs, and the number of threads changes no bit of the result.
template <typename Scalar>
class PackedXpbd : public XpbdSystem<Scalar> {
public:
    PackedXpbd(TetSlabs slabs, const XpbdFlesh& flesh)
        : XpbdSystem<Scalar>(slabs.order().new_of_old, slabs.rows(), flesh.w),
          slabs_(std::move(slabs)),
          alpha_(Scalar(flesh.material.alpha)),
          size_m_(flesh.size_m),
          batches_(slabs_.slabs()),
          mode_places_(flesh.hold.modes().size())
    {
        for (const HoldMode& mode : flesh.hold.modes()) sums_.push_back(mode.v.sum());
        for (int s = 0; s < slabs_.slabs(); ++s) {
            Slab& slab = batches_[s];
            const std::vector<int>& tets = slabs_.of_slab(s);
            std::vector<int> held;
            std::copy_if(tets.begin(), tets.end(), std::back_inserter(held),
                         [&](int t) { return flesh.first_mode[t] < flesh.first_mode[t + 1]; });
            slab.hold_members = slabs_.batches(held);
            slab.tet_members = slabs_.batches(tets);
            slabs_.fill(s, slab.hold_members, slab.holds, [&](int b, int lane, int tet) {
                for (int r = flesh.first_mode[tet]; r < flesh.first_mode[tet + 1]; ++r)
                    mode_places_[r] = {s, b, r - flesh.first_mode[tet], lane};
                fill_hold(slab.holds[b], lane, tet, flesh);
            });
            slabs_.fill(s, slab.tet_members, slab.tets,
                        [&](int b, int lane, int tet) { fill_tet(slab.tets[b], lane, tet, flesh); });
        }
    }

    void set_targets(const Positions& targets) override
    {
        set_origin(targets);
        for (Slab& slab : batches_)
            for (HoldBatch<Scalar>& batch : slab.holds)
                std::fill_n(&batch.target[0][0][0], 4 * 3 * batch_size, Scalar(0));
        for (std::size_t r = 0; r < mode_places_.size(); ++r) {
            const auto& [slab, b, mode, lane] = mode_places_[r];
            HoldBatch<Scalar>& batch = batches_[slab].holds[b];
            // v^T (x - origin) = d - (sum of v) origin. Far away, the roundings of v in float would be multiplied by
            // the distance.
            const double sum = is_far_ ? sums_[r] : sum_of_mode(mode_places_[r]);
            for (int axis = 0; axis < 3; ++axis)
                batch.target[mode][axis][lane] =
                    Scalar(targets(static_cast<Eigen::Index>(r), axis) - sum * this->origin_(axis));
        }
    }

    void forget() override
    {
        for (Slab& slab : batches_) {
            for (HoldBatch<Scalar>& batch : slab.holds)
                std::fill_n(&batch.multiplier[0][0][0], 4 * 3 * batch_size, Scalar(0));
            for (NeoHookeanBatch<Scalar>& batch : slab.tets) {
                std::fill_n(&batch.multiplier[0][0], 2 * batch_size, Scalar(0));
                std::fill_n(&batch.applied[0][0], 9 * batch_size, Scalar(0));
            }
        }
    }

    void iterate(Rows<Scalar>& x, bool with_residual) override
    {
        slabs_.for_each([&](int s) {
            Slab& slab = batches_[s];
            visit_holds(slab.holds.data(), static_cast<int>(slab.holds.size()), x.data());
            visit_tets(slab.tets.data(), static_cast<int>(slab.tets.size()), alpha_, with_residual, x.data());
        });
    }

    std::vector<XpbdVisit> visits() const override
    {
        std::vector<XpbdVisit> visits;
        for (const int parity : {0, 1})
            for (std::size_t s = parity; s < batches_.size(); s += 2)
                for (const bool is_hold : {true, false})
                    for (const std::vector<int>& batch : is_hold ? batches_[s].hold_members : batches_[s].tet_members)
                        for (const int tet : batch) visits.push_back({is_hold, tet});
        return visits;
    }

private:
    struct Slab {
        std::vector<std::vector<int>> hold_members, tet_members;  // tets of each batch
        std::vector<HoldBatch<Scalar>> holds;
        std::vector<NeoHookeanBatch<Scalar>> tets;
    };
    struct ModePlace {
        int slab, batch, mode, lane;
    };

    double sum_of_mode(const ModePlace& place) const
    {
        double sum = 0.0;
        for (int i = 0; i < 4; ++i) sum += double(batches_[place.slab].holds[place.batch].v[place.mode][i][place.lane]);
        return sum;
    }

    // Places the origin of the rows near the flesh. The mean of the targets d serves for bodies near the world's
    // origin. A target is a point times the sum of its v, which may be anything from -2 to 2. Far from the world's
    // origin, the rows therefore have the origin o that fits d = (sum of v) o for all targets by least squares.
    void set_origin(const Positions& targets)
    {
        constexpr double nearby = 16.0;  // sizes of the body: at most 4 of the 24 bits of a float
        this->origin_.setZero();
        is_far_ = false;
        if (targets.rows() == 0) return;
        this->origin_ = targets.colwise().mean();
        Vec3 place = Vec3::Zero();
        double squares = 0.0;
        for (std::size_t r = 0; r < sums_.size(); ++r) {
            place += sums_[r] * targets.row(static_cast<Eigen::Index>(r)).transpose();
            squares += sums_[r] * sums_[r];
        }
        is_far_ = squares > 0.0 && (place / squares - this->origin_).norm() > nearby * size_m_;
        if (is_far_) this->origin_ = place / squares;
    }

    static void fill_hold(HoldBatch<Scalar>& batch, int lane, int t, const XpbdFlesh& flesh)
    {
        for (int r = flesh.first_mode[t]; r < flesh.first_mode[t + 1]; ++r) {
            const HoldMode& mode = flesh.hold.modes()[r];
            const int place = r - flesh.first_mode[t];
            double w_gradient2 = 0.0;
            for (int i = 0; i < 4; ++i) {
                batch.v[place][i][lane] = Scalar(mode.v(i));
                w_gradient2 += flesh.w(flesh.tets[t].vertex[i]) * mode.v(i) * mode.v(i);
            }
            batch.stiffness[place][lane] = Scalar(mode.stiffness);
            batch.share[place][lane] = Scalar(1.0 / (1.0 + mode.stiffness * w_gradient2));
        }
    }

    static void fill_tet(NeoHookeanBatch<Scalar>& batch, int lane, int t, const XpbdFlesh& flesh)
    {
        const NeoHookeanTet& tet = flesh.tets[t];
        const Eigen::Matrix<double, 3, 4> g = shape_gradients(tet);
        Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
        for (int i = 0; i < 4; ++i) S += flesh.w(tet.vertex[i]) * g.col(i) * g.col(i).transpose();
        for (int k = 0; k < 9; ++k) batch.rest_inverse[k][lane] = Scalar(tet.rest_inverse(k / 3, k % 3));
        const double entries[6] = {S(0, 0), S(1, 1), S(2, 2), S(1, 2), S(0, 2), S(0, 1)};
        for (int k = 0; k < 6; ++k) batch.weighted[k][lane] = Scalar(entries[k]);
        batch.hydrostatic[lane] = Scalar(flesh.material.lambda * tet.volume);
        batch.deviatoric[lane] = Scalar(flesh.material.mu * tet.volume);
    }

    TetSlabs slabs_;
    Scalar alpha_;
    double size_m_;
    std::vector<Slab> batches_;
    std::vector<ModePlace> mode_places_;  // of each mode
    std::vector<double> sums_;            // of v of each mode, in double
    bool is_far_ = false;                 // the flesh from the mean of the targets
};

}  // namespace

PlainXpbd::PlainXpbd(const XpbdFlesh& flesh) : PlainXpbd(flesh, in_file_order(flesh))
{
}

PlainXpbd::PlainXpbd(const XpbdFlesh& flesh, const std::vector<XpbdVisit>& visits)
    : XpbdSystem(flesh.w), flesh_(flesh), visits_(visits)
{
    for (const NeoHookeanTet& tet : flesh.tets) {
        const Eigen::Matrix<double, 3, 4> g = shape_gradients(tet);
        Eigen::Vector4d w;
        for (int i = 0; i < 4; ++i) w(i) = flesh.w(tet.vertex[i]);
        weighted_.push_back(g * w.asDiagonal() * g.transpose());
    }
    forget();
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

// Solves k C + lambda = 0 for each mode of the hold and each of x, y and z, where C = v^T x - d and k is the stiffness.
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

// The equations of xpbd_neo_hookean.hpp. All gradients have the form A g_i, with H = dC_H/dF and D = dC_D/dF for A;
// with S = sum_i w_i g_i g_i^T, sum_i w_i (A g_i) . (B g_i) = tr(A S B^T).
void PlainXpbd::visit_tet(int t, Rows<double>& x, bool with_residual)
{
    const NeoHookeanTet& tet = flesh_.tets[t];
    State& state = state_[t];
    const auto p = [&](int i) { return Vec3(Vec3::Map(x[tet.vertex[i]])); };
    const Eigen::Matrix3d F = deformation_gradient(tet, p(0), p(1), p(2), p(3));
    const Eigen::Matrix3d H = hydrostatic_gradient(F);
    const Eigen::Matrix3d D = deviatoric_gradient(F);
    const Eigen::Matrix3d HS = H * weighted_[t];
    const Eigen::Matrix3d DS = D * weighted_[t];
    const double k_H = flesh_.material.lambda * tet.volume;
    const double k_D = flesh_.material.mu * tet.volume;

    Eigen::Matrix3d residual = Eigen::Matrix3d::Zero();
    if (with_residual) residual = state.applied - state.multipliers(0) * H - state.multipliers(1) * D;
    const double right_H =
        -k_H * hydrostatic_value(F, flesh_.material.alpha) - state.multipliers(0) + k_H * inner(HS, residual);
    const double right_D = -k_D * deviatoric_value(F) - state.multipliers(1) + k_D * inner(DS, residual);
    const double HH = k_H * inner(HS, H) + 1.0;
    const double HD = k_H * inner(HS, D);
    const double DH = k_D * inner(HS, D);
    const double DD = k_D * inner(DS, D) + 1.0;
    const double determinant = HH * DD - HD * DH;  // 1 or more, by Cauchy and Schwarz
    const Eigen::Vector2d change((right_H * DD - HD * right_D) / determinant,
                                 (HH * right_D - DH * right_H) / determinant);
    state.multipliers += change;

    const Eigen::Matrix3d more = change(0) * H + change(1) * D - residual;
    state.applied += more;
    const Eigen::Matrix<double, 3, 4> force = vertex_gradients(tet, more);
    for (int i = 0; i < 4; ++i) Vec3::Map(x[tet.vertex[i]]) += flesh_.w(tet.vertex[i]) * force.col(i);
}

template <typename Scalar>
std::unique_ptr<XpbdSystem<Scalar>> make_xpbd_system(const TetMesh& mesh, const XpbdFlesh& flesh, bool packed,
                                                     int threads)
{
    if constexpr (std::is_same_v<Scalar, double>)
        if (!packed) return std::make_unique<PlainXpbd>(flesh);
    return std::make_unique<PackedXpbd<Scalar>>(TetSlabs(mesh.tets, static_cast<int>(mesh.rest.rows()), threads),
                                                flesh);
}

template std::unique_ptr<XpbdSystem<float>> make_xpbd_system(const TetMesh&, const XpbdFlesh&, bool, int);
template std::unique_ptr<XpbdSystem<double>> make_xpbd_system(const TetMesh&, const XpbdFlesh&, bool, int);

}  // namespace pbs
