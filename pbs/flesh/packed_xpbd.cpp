#include "pbs/flesh/xpbd_neo_hookean.hpp"

#include "pbs/packed/groups.hpp"
#include "pbs/packed/rows.hpp"
#include "pbs/solver/batched/batch_program.hpp"

#include <algorithm>
#include <iterator>

namespace pbs {

template <typename Scalar>
PackedXpbd<Scalar>::PackedXpbd(const TetMesh& mesh, const XpbdFlesh& flesh, int threads)
    : order_(order_vertices(mesh.tets, static_cast<int>(mesh.rest.rows()), vertices_a_slab(static_cast<int>(mesh.rest.rows())))),
      parallel_(order_.slabs() >= 3 ? threads : 1),
      w_(flesh.w),
      alpha_(Scalar(flesh.material.alpha)),
      slabs_(order_.slabs()),
      place_(flesh.hold.modes().size())
{
    rows_ = rows_with_dummies(static_cast<int>(mesh.rest.rows()), order_.slabs());
    std::vector<std::array<int, 4>> vertex;
    for (const NeoHookeanTet& tet : flesh.tets) vertex.push_back(tet.vertex);
    const auto tets = slabs_of_tets(vertex, order_);
    for (int slab = 0; slab < order_.slabs(); ++slab) fill_slab(slab, tets[slab], flesh);
}

template <typename Scalar>
void PackedXpbd<Scalar>::fill_slab(int s, const std::vector<int>& tets, const XpbdFlesh& flesh)
{
    Slab& slab = slabs_[s];
    std::vector<int> held;
    std::copy_if(tets.begin(), tets.end(), std::back_inserter(held), [&](int t) { return flesh.first_mode[t] < flesh.first_mode[t + 1]; });
    BatchScheduler scheduler(static_cast<int>(order_.new_of_old.size()));
    slab.hold_members = scheduled(scheduler, held, flesh);
    slab.tet_members = scheduled(scheduler, tets, flesh);
    slab.holds.resize(slab.hold_members.size());
    slab.tets.resize(slab.tet_members.size());
    const auto fill = [&](auto& batches, const Members& members, auto&& fill_lane) {
        for (std::size_t b = 0; b < batches.size(); ++b)
            for (int lane = 0; lane < batch_size; ++lane) {
                const bool is_there = lane < static_cast<int>(members[b].size());
                set_offsets(batches[b], lane, s, is_there ? &flesh.tets[members[b][lane]] : nullptr);
                if (is_there) fill_lane(static_cast<int>(b), lane, members[b][lane]);
            }
    };
    fill(slab.holds, slab.hold_members, [&](int b, int lane, int tet) {
        for (int r = flesh.first_mode[tet]; r < flesh.first_mode[tet + 1]; ++r) place_[r] = {s, b, r - flesh.first_mode[tet], lane};
        fill_hold(slab.holds[b], lane, tet, flesh);
    });
    fill(slab.tets, slab.tet_members, [&](int b, int lane, int tet) { fill_tet(slab.tets[b], lane, tet, flesh); });
}

template <typename Scalar>
auto PackedXpbd<Scalar>::scheduled(BatchScheduler& scheduler, const std::vector<int>& tets, const XpbdFlesh& flesh) const -> Members
{
    std::vector<ConstraintGroup> groups;
    for (const int t : tets) {
        const auto& v = flesh.tets[t].vertex;
        groups.push_back({GroupKind::tet, {v[0], v[1], v[2], v[3]}, {}});
    }
    Members batches = scheduler.schedule(groups);
    for (std::vector<int>& batch : batches)
        for (int& member : batch) member = tets[member];
    return batches;
}

template <typename Scalar>
template <typename Batch>
void PackedXpbd<Scalar>::set_offsets(Batch& batch, int lane, int slab, const NeoHookeanTet* tet) const
{
    const int dummies = rows_ - (order_.slabs() - slab) * dummies_of_slab;
    for (int i = 0; i < 4; ++i) batch.offset[i][lane] = 4u * (tet ? order_.new_of_old[tet->vertex[i]] : dummies + 4 * lane + i);
}

template <typename Scalar>
void PackedXpbd<Scalar>::fill_hold(HoldBatch<Scalar>& batch, int lane, int t, const XpbdFlesh& flesh)
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

template <typename Scalar>
void PackedXpbd<Scalar>::fill_tet(NeoHookeanBatch<Scalar>& batch, int lane, int t, const XpbdFlesh& flesh)
{
    const NeoHookeanTet& tet = flesh.tets[t];
    const Eigen::Matrix<double, 3, 4> g = vertex_gradients(tet, Eigen::Matrix3d::Identity());
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
    for (int i = 0; i < 4; ++i) S += flesh.w(tet.vertex[i]) * g.col(i) * g.col(i).transpose();
    for (int k = 0; k < 9; ++k) batch.rest_inverse[k][lane] = Scalar(tet.rest_inverse(k / 3, k % 3));
    const double entries[6] = {S(0, 0), S(1, 1), S(2, 2), S(1, 2), S(0, 2), S(0, 1)};
    for (int k = 0; k < 6; ++k) batch.weighted[k][lane] = Scalar(entries[k]);
    batch.hydrostatic[lane] = Scalar(flesh.material.lambda * tet.volume);
    batch.deviatoric[lane] = Scalar(flesh.material.mu * tet.volume);
}

template <typename Scalar>
Rows<Scalar> PackedXpbd<Scalar>::rows() const
{
    Rows<Scalar> rows(rows_);
    for (int i = 0; i < rows.size(); ++i) rows[i][3] = i < w_.size() ? Scalar(w_(order_.old_of_new[i])) : Scalar(1);
    return rows;
}

template <typename Scalar>
void PackedXpbd<Scalar>::set_targets(const Positions& targets)
{
    origin_.setZero();
    if (targets.rows() > 0) origin_ = targets.colwise().mean();
    for (Slab& slab : slabs_)
        for (HoldBatch<Scalar>& batch : slab.holds) std::fill_n(&batch.target[0][0][0], 4 * 3 * batch_size, Scalar(0));
    for (std::size_t r = 0; r < place_.size(); ++r) {
        const auto& [slab, b, mode, lane] = place_[r];
        HoldBatch<Scalar>& batch = slabs_[slab].holds[b];
        double sum = 0.0;  // v^T (x - origin) = d - (sum of v) origin
        for (int i = 0; i < 4; ++i) sum += double(batch.v[mode][i][lane]);
        for (int axis = 0; axis < 3; ++axis)
            batch.target[mode][axis][lane] = Scalar(targets(static_cast<Eigen::Index>(r), axis) - sum * origin_(axis));
    }
}

template <typename Scalar>
void PackedXpbd<Scalar>::load(const Positions& x, Rows<Scalar>& rows) const
{
    load_rows(x, order_.new_of_old, origin_, rows);
}

template <typename Scalar>
void PackedXpbd<Scalar>::store(const Rows<Scalar>& rows, Positions& x) const
{
    store_rows(rows, order_.new_of_old, origin_, x);
}

template <typename Scalar>
void PackedXpbd<Scalar>::forget()
{
    for (Slab& slab : slabs_) {
        for (HoldBatch<Scalar>& batch : slab.holds) std::fill_n(&batch.multiplier[0][0][0], 4 * 3 * batch_size, Scalar(0));
        for (NeoHookeanBatch<Scalar>& batch : slab.tets) {
            std::fill_n(&batch.multiplier[0][0], 2 * batch_size, Scalar(0));
            std::fill_n(&batch.applied[0][0], 9 * batch_size, Scalar(0));
        }
    }
}

template <typename Scalar>
void PackedXpbd<Scalar>::iterate(Rows<Scalar>& x, bool with_residual)
{
    for (const int parity : {0, 1})
        parallel_.for_each((order_.slabs() + 1 - parity) / 2, [&](int pair) {
            Slab& slab = slabs_[2 * pair + parity];
            visit_holds(slab.holds.data(), static_cast<int>(slab.holds.size()), x.data());
            visit_tets(slab.tets.data(), static_cast<int>(slab.tets.size()), alpha_, with_residual, x.data());
        });
}

template <typename Scalar>
std::vector<XpbdVisit> PackedXpbd<Scalar>::visits() const
{
    std::vector<XpbdVisit> visits;
    for (const int parity : {0, 1})
        for (std::size_t s = parity; s < slabs_.size(); s += 2)
            for (const bool is_hold : {true, false})
                for (const std::vector<int>& batch : is_hold ? slabs_[s].hold_members : slabs_[s].tet_members)
                    for (const int tet : batch) visits.push_back({is_hold, tet});
    return visits;
}

template class PackedXpbd<float>;
template class PackedXpbd<double>;

}  // namespace pbs
