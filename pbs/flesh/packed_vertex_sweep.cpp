#include "pbs/flesh/vbd.hpp"

#include "pbs/packed/rows.hpp"
#include "pbs/packed/vertex_order.hpp"

#include <algorithm>

namespace pbs {
namespace {

constexpr int vertices_of_chunk = 512;       // some 10 us of work
constexpr int vertices_for_threads = 16384;  // fewer are done sooner than threads wake

}  // namespace

template <typename Scalar>
PackedVertexSweep<Scalar>::PackedVertexSweep(const TetMesh& mesh, const FleshEnergy& energy, int threads)
    : order_(breadth_first(mesh.tets, static_cast<int>(mesh.rest.rows()))),
      rows_(static_cast<int>(mesh.rest.rows()) + batch_size),
      parallel_(mesh.rest.rows() >= vertices_for_threads ? threads : 1)
{
    const std::vector<VertexStar> stars = vertex_stars(energy);
    for (const std::vector<int>& colour : vertex_colours(mesh.tets, static_cast<int>(mesh.rest.rows()))) {
        colours_.emplace_back();
        for (auto begin = colour.begin(); begin != colour.end();) {
            const auto end = begin + std::min<std::ptrdiff_t>(vertices_of_chunk, colour.end() - begin);
            add_chunk(stars, {begin, end});
            begin = end;
        }
    }
    centres_ = rows();
    for (std::size_t i = 0; i < stars.size(); ++i) centres_[order_.new_of_old[i]][3] = Scalar(stars[i].hold);
}

template <typename Scalar>
void PackedVertexSweep<Scalar>::add_chunk(const std::vector<VertexStar>& stars, std::vector<int> vertices)
{
    std::stable_sort(vertices.begin(), vertices.end(), [&](int a, int b) { return stars[a].tets.size() > stars[b].tets.size(); });
    const int before = static_cast<int>(batches_.size()), count = static_cast<int>(vertices.size());
    for (int first = 0; first < count; first += batch_size) add_batch(stars, vertices.data() + first, std::min(batch_size, count - first));
    colours_.back().push_back({before, static_cast<int>(batches_.size()) - before});
}

template <typename Scalar>
void PackedVertexSweep<Scalar>::add_batch(const std::vector<VertexStar>& stars, const int* vertices, int count)
{
    VertexBatch<Scalar>& batch = batches_.emplace_back();
    batch.first = incidences_.size();
    batch.count = static_cast<int>(stars[vertices[0]].tets.size());
    incidences_.resize(batch.first + batch.count);
    for (int lane = 0; lane < batch_size; ++lane) {
        const VertexStar none, &star = lane < count ? stars[vertices[lane]] : none;
        const std::uint32_t own = 4u * (lane < count ? order_.new_of_old[vertices[lane]] : rows_ - batch_size + lane);
        batch.offset[lane] = own;
        batch.diagonal[lane] = Scalar(star.diagonal);
        for (int t = 0; t < batch.count; ++t) {
            const bool is_tet = t < static_cast<int>(star.tets.size()) && star.diagonal > 0.0;
            VertexIncidence<Scalar>& incidence = incidences_[batch.first + t];
            for (int k = 0; k < 3; ++k) incidence.other[k][lane] = is_tet ? 4u * order_.new_of_old[star.tets[t].other[k]] : own;
            for (int k = 0; k < 3; ++k) incidence.w[k][lane] = is_tet ? Scalar(star.tets[t].w[k]) : Scalar(0);
            incidence.kappa[lane] = is_tet ? Scalar(star.tets[t].kappa) : Scalar(0);
            incidence.d[lane] = is_tet ? Scalar(star.tets[t].d) : Scalar(0);
        }
    }
}

template <typename Scalar>
void PackedVertexSweep<Scalar>::set_centres(const Positions& centres)
{
    origin_ = load_held_centres(centres, order_.new_of_old, centres_);
}

template <typename Scalar>
void PackedVertexSweep<Scalar>::load(const Positions& x, Rows<Scalar>& rows) const
{
    load_rows(x, order_.new_of_old, origin_, rows);
}

template <typename Scalar>
void PackedVertexSweep<Scalar>::store(const Rows<Scalar>& rows, Positions& x) const
{
    store_rows(rows, order_.new_of_old, origin_, x);
}

template <typename Scalar>
void PackedVertexSweep<Scalar>::move(double omega, Rows<Scalar>& x)
{
    for (const std::vector<Chunk>& chunks : colours_)
        parallel_.for_each(static_cast<int>(chunks.size()), [&](int c) {
            move_vertices(batches_.data() + chunks[c].first, chunks[c].count, incidences_.data(), centres_.data(), Scalar(omega), x.data());
        });
}

template <typename Scalar>
void PackedVertexSweep<Scalar>::extrapolate(double omega, const Rows<Scalar>& before, Rows<Scalar>& x) const
{
    pbs::extrapolate(Scalar(omega), before.data(), x.size(), x.data());
}

template <typename Scalar>
std::size_t PackedVertexSweep<Scalar>::bytes() const
{
    return batches_.size() * sizeof(VertexBatch<Scalar>) + incidences_.size() * sizeof(VertexIncidence<Scalar>) +
           2 * 4 * sizeof(Scalar) * rows_;
}

template class PackedVertexSweep<float>;
template class PackedVertexSweep<double>;

}  // namespace pbs
