// The plain implementation of VertexSweep: one vertex after the other, in double.
#pragma once

#include "pbs/flesh/vbd.hpp"

namespace pbs {

class PlainVertexSweep : public VertexSweep<double> {
public:
    PlainVertexSweep(const TetMesh& mesh, const FleshEnergy& energy);

    Rows<double> rows() const override { return Rows<double>(static_cast<int>(stars_.size())); }
    void set_centres(const Positions& centres) override { centres_ = centres; }
    void load(const Positions& x, Rows<double>& rows) const override;
    void store(const Rows<double>& rows, Positions& x) const override;
    void move(double omega, Rows<double>& x) override;
    void extrapolate(double omega, const Rows<double>& before, Rows<double>& x) const override;
    std::size_t bytes() const override;

private:
    std::vector<VertexStar> stars_;  // #V
    std::vector<std::vector<int>> colours_;
    Positions centres_, x_;
};

}  // namespace pbs
