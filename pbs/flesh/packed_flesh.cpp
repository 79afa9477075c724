#include "pbs/flesh/packed_flesh.hpp"

#include "pbs/flesh/positions_in_rows.hpp"
#include "pbs/flesh/slabs_of_tets.hpp"
#include "pbs/solver/batched/batch_schedule.hpp"
#include "pbs/solver/batched/batched_constraints.hpp"

#include <numeric>

namespace pbs {

template <typename Scalar>
PackedFlesh<Scalar>::PackedFlesh(const TetMesh& mesh, const FleshEnergy& energy, const CholeskyFactor& factor, int threads)
    : order_(order_vertices(mesh.tets, static_cast<int>(mesh.rest.rows()), vertices_a_slab(static_cast<int>(mesh.rest.rows())))),
      parallel_(order_.slabs() >= 3 ? threads : 1),
      slab_energy_(order_.slabs()),
      solve_(factor, order_.new_of_old)
{
    const int vertices = static_cast<int>(mesh.rest.rows());
    rows_ = rows_with_dummies(vertices, order_.slabs());
    std::vector<std::array<int, 4>> vertex;
    for (const FleshTet& tet : energy.tets()) vertex.push_back(tet.vertex);
    const auto slabs = slabs_of_tets(vertex, order_);
    for (int slab = 0; slab < order_.slabs(); ++slab) {
        std::vector<const FleshTet*> tets;
        for (const int t : slabs[slab]) tets.push_back(&energy.tets()[t]);
        fill_slab(slab, tets);
    }
    centres_ = rows();
    for (int i = 0; i < vertices; ++i) centres_[i][3] = Scalar(energy.hold()(order_.old_of_new[i]));
}

template <typename Scalar>
void PackedFlesh<Scalar>::fill_slab(int slab, const std::vector<const FleshTet*>& tets)
{
    std::vector<ConstraintGroup> groups;
    for (const FleshTet* tet : tets)
        groups.push_back({GroupKind::tet, {tet->vertex[0], tet->vertex[1], tet->vertex[2], tet->vertex[3]}, {}});
    const int dummies = rows_ - (order_.slabs() - slab) * dummies_of_slab;
    BatchScheduler scheduler(static_cast<int>(order_.new_of_old.size()));
    std::vector<FleshBatch<Scalar>>& batches = batches_.emplace_back();
    for (const std::vector<int>& members : scheduler.schedule(groups)) {
        FleshBatch<Scalar>& batch = batches.emplace_back();
        for (int lane = 0; lane < batch_size; ++lane) {
            const FleshTet* tet = lane < static_cast<int>(members.size()) ? tets[members[lane]] : nullptr;
            for (int i = 0; i < 4; ++i) batch.offset[i][lane] = 4u * (tet ? order_.new_of_old[tet->vertex[i]] : dummies + 4 * lane + i);
            if (!tet) continue;
            for (int e = 0; e < 6; ++e) batch.w[e][lane] = Scalar(tet->w[e]);
            batch.kappa[lane] = Scalar(tet->kappa);
            batch.d[lane] = Scalar(tet->d);
        }
    }
}

template <typename Scalar>
void PackedFlesh<Scalar>::set_centres(const Positions& centres)
{
    origin_ = mean_centre(centres, order_.new_of_old, centres_);
    load(centres, centres_);
}

template <typename Scalar>
void PackedFlesh<Scalar>::load(const Positions& x, Rows<Scalar>& rows) const
{
    load_rows(x, order_.new_of_old, origin_, rows);
}

template <typename Scalar>
void PackedFlesh<Scalar>::store(const Rows<Scalar>& rows, Positions& x) const
{
    store_rows(rows, order_.new_of_old, origin_, x);
}

template <typename Scalar>
double PackedFlesh<Scalar>::value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient)
{
    const double of_hold = set_gradient_of_hold(centres_.data(), centres_.size(), x.data(), gradient.data());
    for (const int parity : {0, 1})
        parallel_.for_each((order_.slabs() + 1 - parity) / 2, [&](int pair) {
            const auto& batches = batches_[2 * pair + parity];
            slab_energy_[2 * pair + parity] =
                add_gradient_of_tets(batches.data(), static_cast<int>(batches.size()), x.data(), gradient.data());
        });
    return std::accumulate(slab_energy_.begin(), slab_energy_.end(), of_hold);
}

template <typename Scalar>
std::size_t PackedFlesh<Scalar>::bytes() const
{
    std::size_t batches = 0;
    for (const auto& slab : batches_) batches += slab.size();
    const std::size_t of_rows = 4 * sizeof(Scalar) * rows_;
    return batches * sizeof(FleshBatch<Scalar>) + 3 * of_rows + 2 * (solve_.bytes() + of_rows);
}

template class PackedFlesh<float>;
template class PackedFlesh<double>;

}  // namespace pbs
