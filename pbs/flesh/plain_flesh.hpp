// The plain implementation of FleshSystem: FleshEnergy in file order and a loop per entry of the factor, in double.
#pragma once

#include "pbs/flesh/flesh_system.hpp"

namespace pbs {

class PlainFlesh : public FleshSystem<double> {
public:
    PlainFlesh(const FleshEnergy& energy, const CholeskyFactor& factor);

    Rows<double> rows() const override { return Rows<double>(static_cast<int>(place_.size())); }
    void set_centres(const Positions& centres) override { centres_ = centres; }
    void load(const Positions& x, Rows<double>& rows) const override;
    void store(const Rows<double>& rows, Positions& x) const override;
    double value_and_gradient(const Rows<double>& x, Rows<double>& gradient) override;
    void precondition(Rows<double>& residual) override;
    double dot(const Rows<double>& a, const Rows<double>& b) const override;
    void add(double factor, const Rows<double>& a, Rows<double>& to) const override;
    std::size_t bytes() const override;

private:
    FleshEnergy energy_;
    CholeskyFactor factor_;
    std::vector<int> place_;  // the identity, #V
    Positions centres_, x_, gradient_;
    std::vector<double> work_;
};

}  // namespace pbs
