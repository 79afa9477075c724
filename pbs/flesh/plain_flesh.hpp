// The plain implementation of FleshSystem: the energy in file order and a loop per entry of the factor, in double.
#pragma once

#include "pbs/flesh/flesh_system.hpp"

namespace pbs {

// Energy: FleshEnergy or ProjectiveEnergy.
template <typename Energy>
class PlainSystem : public FleshSystem<double> {
public:
    PlainSystem(const Energy& energy, const CholeskyFactor& factor);

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
    Energy energy_;
    CholeskyFactor factor_;
    std::vector<int> place_;  // the identity, #V
    Positions centres_, x_, gradient_;
    std::vector<double> work_;
};

using PlainFlesh = PlainSystem<FleshEnergy>;
using PlainProjective = PlainSystem<ProjectiveEnergy>;

}  // namespace pbs
