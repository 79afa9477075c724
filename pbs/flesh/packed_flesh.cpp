#include "pbs/flesh/packed_flesh.hpp"

#include "pbs/packed/groups.hpp"
#include "pbs/packed/rows.hpp"

#include <numeric>

namespace pbs {

template <typename Scalar, typename Energy>
PackedSystem<Scalar, Energy>::PackedSystem(const TetMesh& mesh, const Energy& energy, const CholeskyFactor& factor, int threads)
    : order_(order_vertices(mesh.tets, static_cast<int>(mesh.rest.rows()), vertices_a_slab(static_cast<int>(mesh.rest.rows())))),
      parallel_(order_.slabs() >= 3 ? threads : 1),
      slab_energy_(order_.slabs()),
      solve_(factor, order_.new_of_old)
{
    const int vertices = static_cast<int>(mesh.rest.rows());
    rows_ = rows_with_dummies(vertices, order_.slabs());
    std::vector<std::array<int, 4>> vertex;
    for (const auto& tet : energy.tets()) vertex.push_back(tet.vertex);
    const auto slabs = slabs_of_tets(vertex, order_);
    for (int slab = 0; slab < order_.slabs(); ++slab) fill_slab(slab, slabs[slab], energy);
    centres_ = rows();
    for (int i = 0; i < vertices; ++i) centres_[i][3] = Scalar(energy.hold()(order_.old_of_new[i]));
}

template <typename Scalar, typename Energy>
void PackedSystem<Scalar, Energy>::fill_slab(int slab, const std::vector<int>& tets, const Energy& energy)
{
    std::vector<ConstraintGroup> groups;
    for (const int t : tets) {
        const std::array<int, 4>& vertex = energy.tets()[t].vertex;
        groups.push_back({GroupKind::tet, {vertex[0], vertex[1], vertex[2], vertex[3]}, {}});
    }
    const int dummies = rows_ - (order_.slabs() - slab) * dummies_of_slab;
    BatchScheduler scheduler(static_cast<int>(order_.new_of_old.size()));
    PackedTets<Scalar, Energy>& packed = tets_.emplace_back(energy);
    for (const std::vector<int>& members : scheduler.schedule(groups)) {
        packed.add_batch();
        for (int lane = 0; lane < batch_size; ++lane) {
            const bool is_tet = lane < static_cast<int>(members.size());
            TetOffsets offset;
            for (int i = 0; i < 4; ++i)
                offset[i] = 4u * (is_tet ? order_.new_of_old[energy.tets()[tets[members[lane]]].vertex[i]] : dummies + 4 * lane + i);
            if (is_tet)
                packed.set_tet(lane, tets[members[lane]], offset);
            else
                packed.set_dummy(lane, offset);
        }
    }
}

template <typename Scalar, typename Energy>
void PackedSystem<Scalar, Energy>::set_centres(const Positions& centres)
{
    origin_ = load_held_centres(centres, order_.new_of_old, centres_);
}

template <typename Scalar, typename Energy>
void PackedSystem<Scalar, Energy>::load(const Positions& x, Rows<Scalar>& rows) const
{
    load_rows(x, order_.new_of_old, origin_, rows);
}

template <typename Scalar, typename Energy>
void PackedSystem<Scalar, Energy>::store(const Rows<Scalar>& rows, Positions& x) const
{
    store_rows(rows, order_.new_of_old, origin_, x);
}

template <typename Scalar, typename Energy>
double PackedSystem<Scalar, Energy>::value_and_gradient(const Rows<Scalar>& x, Rows<Scalar>& gradient)
{
    const double of_hold = set_gradient_of_hold(centres_.data(), centres_.size(), x.data(), gradient.data());
    for (const int parity : {0, 1})
        parallel_.for_each((order_.slabs() + 1 - parity) / 2, [&](int pair) {
            const int slab = 2 * pair + parity;
            slab_energy_[slab] = tets_[slab].add_gradient(x.data(), gradient.data());
        });
    return std::accumulate(slab_energy_.begin(), slab_energy_.end(), of_hold);
}

template class PackedSystem<float, FleshEnergy>;
template class PackedSystem<double, FleshEnergy>;
template class PackedSystem<float, ProjectiveEnergy>;
template class PackedSystem<double, ProjectiveEnergy>;

namespace {

template <typename Batch>
void set_offsets(Batch& batch, int lane, const TetOffsets& offset)
{
    for (int i = 0; i < 4; ++i) batch.offset[i][lane] = offset[i];
}

template <typename Scalar>
Vec3 point(const Scalar* rows, std::uint32_t offset)
{
    return {double(rows[offset]), double(rows[offset + 1]), double(rows[offset + 2])};
}

}  // namespace

template <typename Scalar>
void PackedTets<Scalar, FleshEnergy>::set_tet(int lane, int tet, const TetOffsets& offset)
{
    FleshBatch<Scalar>& batch = batches_.back();
    const FleshTet& from = energy_->tets()[tet];
    set_offsets(batch, lane, offset);
    for (int e = 0; e < 6; ++e) batch.w[e][lane] = Scalar(from.w[e]);
    batch.kappa[lane] = Scalar(from.kappa);
    batch.d[lane] = Scalar(from.d);
}

template <typename Scalar>
void PackedTets<Scalar, FleshEnergy>::set_dummy(int lane, const TetOffsets& offset)
{
    set_offsets(batches_.back(), lane, offset);
}

template <typename Scalar>
void PackedTets<Scalar, ProjectiveEnergy>::add_batch()
{
    batches_.emplace_back();
    refused_.resize(batch_size * batches_.size());
}

template <typename Scalar>
void PackedTets<Scalar, ProjectiveEnergy>::set_tet(int lane, int tet, const TetOffsets& offset)
{
    ProjectiveBatch<Scalar>& batch = batches_.back();
    const ProjectiveTet& from = energy_->tets()[tet];
    set_offsets(batch, lane, offset);
    for (int k = 0; k < 9; ++k) batch.inverse_edges[k][lane] = Scalar(from.inverse_edges(k / 3, k % 3));
    batch.volume[lane] = Scalar(from.volume);
    for (int e = 0; e < 6; ++e) batch.w[e][lane] = Scalar(from.w[e]);
}

template <typename Scalar>
void PackedTets<Scalar, ProjectiveEnergy>::set_dummy(int lane, const TetOffsets& offset)
{
    set_offsets(batches_.back(), lane, offset);
}

template <typename Scalar>
double PackedTets<Scalar, ProjectiveEnergy>::add_gradient(const Scalar* x, Scalar* gradient)
{
    refused_count_ = 0;
    double value = add_gradient_of_projective_tets(batches_.data(), static_cast<int>(batches_.size()), Scalar(weights_.strain),
                                                   Scalar(weights_.volume), x, gradient, refused_.data(), &refused_count_);
    for (int i = 0; i < refused_count_; ++i) value += add_gradient_of_refused(refused_[i], x, gradient);
    return value;
}

template <typename Scalar>
double PackedTets<Scalar, ProjectiveEnergy>::add_gradient_of_refused(int place, const Scalar* x, Scalar* gradient) const
{
    const ProjectiveBatch<Scalar>& batch = batches_[place / batch_size];
    const int lane = place % batch_size;
    ProjectiveTet tet{{}, {}, double(batch.volume[lane]), {}};
    for (int k = 0; k < 9; ++k) tet.inverse_edges(k / 3, k % 3) = double(batch.inverse_edges[k][lane]);
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = point(x, batch.offset[k + 1][lane]) - point(x, batch.offset[0][lane]);
    const ProjectiveForces forces = projective_forces(tet, weights_, edges);
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k < 3; ++k) gradient[batch.offset[k + 1][lane] + axis] += Scalar(forces.columns(axis, k));
        gradient[batch.offset[0][lane] + axis] -= Scalar(forces.columns.row(axis).sum());
    }
    return forces.value;
}

template class PackedTets<float, FleshEnergy>;
template class PackedTets<double, FleshEnergy>;
template class PackedTets<float, ProjectiveEnergy>;
template class PackedTets<double, ProjectiveEnergy>;

}  // namespace pbs
