// The particles of Algorithm 1, before and after their projection, all in double. Particles outside the jiggling zone
// start every step at their LBS position and have no velocity; those inside are integrated. With LbsEntry::increment,
// all are integrated as if they were inside.
//   Particles particles(mesh.rest, jiggle_zone, options);
//   particles.predict(lbs_positions, dt_s);     // then project particles.predicted()
//   particles.update(dt_s);
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/solver/options.hpp"

#include <vector>

namespace pbs {

// The state between steps: positions and, of those that are integrated, velocities.
class Particles {
public:
    // rest: where positions are before the first step [m], #V x 3. jiggle_zone: #V, or empty: nothing is integrated.
    Particles(const Positions& rest, const std::vector<bool>& jiggle_zone, const PbsOptions& options);

    // InputError if the arrays do not have #V rows, or if particles are to be integrated and dt [s] is not positive.
    void check_input(const Positions& lbs_positions, const Positions& bind_points, double dt_s) const;

    void predict(const Positions& lbs_positions, double dt_s);  // lines (2)-(3) in the first step, (6)-(9)
    void update(double dt_s);                                   // lines (15)-(18)

    Positions& predicted() { return p_; }              // p_i [m], #V x 3
    const Positions& predicted() const { return p_; }  // as above
    const Positions& positions() const { return x_; }  // x_i [m], #V x 3
    // v_i [m/s] of the jiggling vertices, #jiggling x 3; none before the first step
    const Positions& velocities() const { return v_; }

private:
    void move_by_lbs_increment(const Positions& lbs_positions);

    Vec3 gravity_m_s2_;
    bool by_increment_;
    std::vector<int> jiggling_;  // vertices that are integrated

    Positions x_, p_;
    Positions v_;           // v_i [m/s] of the jiggling vertices, #jiggling x 3; none before the first step
    Positions lbs_before_;  // LBS positions of the last step [m], by_increment_ alone
};

// The origin of float projections: the mean position, so that a character far from the origin of the world loses no
// digits. In double it is the origin of the world.
template <typename Scalar>
Vec3 local_origin(const Positions& p);

}  // namespace pbs
