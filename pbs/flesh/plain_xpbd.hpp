// The plain implementation of XpbdSystem: one constraint after the other in double, in file order: first all springs, then all tets.
#pragma once

#include "pbs/flesh/xpbd_neo_hookean.hpp"

namespace pbs {

class PlainXpbd final : public XpbdSystem<double> {
public:
    explicit PlainXpbd(const XpbdFlesh& flesh);
    PlainXpbd(const XpbdFlesh& flesh, const std::vector<XpbdVisit>& visits);  // in another order

    Rows<double> rows() const override;
    void set_targets(const Positions& targets) override { targets_ = targets; }
    void load(const Positions& x, Rows<double>& rows) const override;
    void store(const Rows<double>& rows, Positions& x) const override;
    void forget() override;
    void iterate(Rows<double>& x, bool with_residual) override;
    std::vector<XpbdVisit> visits() const override { return visits_; }

    // The multipliers of a tet's constraints C_H and C_D [m^3], and of the modes [m^2], #modes x 3.
    const Eigen::Vector2d& multipliers_of_tet(int tet) const { return state_[tet].multipliers; }
    const Positions& multipliers_of_modes() const { return mode_multipliers_; }

private:
    struct State {
        Eigen::Vector2d multipliers = Eigen::Vector2d::Zero();
        Eigen::Matrix3d applied = Eigen::Matrix3d::Zero();  // P: the tet has applied the force P g_i to vertex i
    };
    void visit_hold(int tet, Rows<double>& x);
    void visit_tet(int tet, Rows<double>& x, bool with_residual);

    XpbdFlesh flesh_;
    std::vector<XpbdVisit> visits_;
    std::vector<Eigen::Matrix3d> weighted_;  // S = sum_i w_i g_i g_i^T of each tet
    std::vector<State> state_;
    Positions targets_, mode_multipliers_;
};

}  // namespace pbs
