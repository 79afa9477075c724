// The packed implementation of VertexSweep: sixteen vertices of one colour side by side. The vertices of a colour are cut into chunks of
// neighbouring ones; in a chunk they are sorted by their number of tets, so that few lanes wait for others. Threads share the chunks of a
// colour. Their number changes no bit, because no vertex of a colour reads another one.
#pragma once

#include "pbs/flesh/flesh_kernels.hpp"
#include "pbs/flesh/vbd.hpp"
#include "pbs/packed/parallel.hpp"
#include "pbs/packed/vertex_order.hpp"

namespace pbs {

template <typename Scalar>
class PackedVertexSweep : public VertexSweep<Scalar> {
public:
    PackedVertexSweep(const TetMesh& mesh, const FleshEnergy& energy, int threads);

    Rows<Scalar> rows() const override { return Rows<Scalar>(rows_); }
    void set_centres(const Positions& centres) override;
    void load(const Positions& x, Rows<Scalar>& rows) const override;
    void store(const Rows<Scalar>& rows, Positions& x) const override;
    void move(double omega, Rows<Scalar>& x) override;
    void extrapolate(double omega, const Rows<Scalar>& before, Rows<Scalar>& x) const override;
    std::size_t bytes() const override;

private:
    struct Chunk {
        int first = 0, count = 0;  // batches
    };

    void add_chunk(const std::vector<VertexStar>& stars, std::vector<int> vertices);
    void add_batch(const std::vector<VertexStar>& stars, const int* vertices, int count);

    VertexOrder order_;
    int rows_ = 0;  // of vertices and, behind them, of sixteen dummies
    Parallel parallel_;
    std::vector<std::vector<Chunk>> colours_;
    std::vector<VertexBatch<Scalar>> batches_;
    std::vector<VertexIncidence<Scalar>> incidences_;
    Rows<Scalar> centres_;  // c_i - origin, a_i
    Vec3 origin_ = Vec3::Zero();
};

}  // namespace pbs
