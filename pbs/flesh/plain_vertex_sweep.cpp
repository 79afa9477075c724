#include "pbs/flesh/vbd.hpp"

#include "pbs/packed/rows.hpp"
#include "pbs/packed/vertex_order.hpp"

namespace pbs {

PlainVertexSweep::PlainVertexSweep(const TetMesh& mesh, const FleshEnergy& energy)
    : stars_(vertex_stars(energy)), colours_(vertex_colours(mesh.tets, static_cast<int>(mesh.rest.rows())))
{
}

void PlainVertexSweep::load(const Positions& x, Rows<double>& rows) const
{
    load_rows(x, rows);
}

void PlainVertexSweep::store(const Rows<double>& rows, Positions& x) const
{
    store_rows(rows, static_cast<Eigen::Index>(stars_.size()), x);
}

void PlainVertexSweep::move(double omega, Rows<double>& x)
{
    store(x, x_);
    for (const std::vector<int>& colour : colours_)
        for (const int i : colour) x_.row(i) -= omega * block_step(vertex_block(stars_[i], i, x_, centres_)).transpose();
    load(x_, x);
}

void PlainVertexSweep::extrapolate(double omega, const Rows<double>& before, Rows<double>& x) const
{
    for (int i = 0; i < static_cast<int>(stars_.size()); ++i)
        for (int axis = 0; axis < 3; ++axis) x[i][axis] = before[i][axis] + omega * (x[i][axis] - before[i][axis]);
}

std::size_t PlainVertexSweep::bytes() const
{
    std::size_t bytes = 2 * sizeof(double) * x_.size() + stars_.size() * sizeof(VertexStar);
    for (const VertexStar& star : stars_) bytes += star.tets.size() * sizeof(IncidentTet);
    return bytes;
}

}  // namespace pbs
