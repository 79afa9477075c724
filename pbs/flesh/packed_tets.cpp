#include "pbs/flesh/packed_flesh.hpp"

namespace pbs {
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
