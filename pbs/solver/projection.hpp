// Lines 11-13 of Algorithm 1: each class of constraints projected once, in a chosen order, on positions in a layout of
// its own.
//   const auto projection = make_projection(std::move(constraints), mesh.tets, options);
//   projection->load(p, q, origin);
//   projection->project_bind_constraints(); ..stretch.. ..volume..
//   projection->store(origin, p);
#pragma once

#include "pbs/solver/constraint_set.hpp"
#include "pbs/solver/step_summary.hpp"

#include <memory>

namespace pbs {

// The largest residual that a sleeping constraint may have.
struct SleepTolerance {
    double ratio = 0.0;     // |l / l0 - 1|, |V / V0 - 1|
    double length_m = 0.0;  // of bind constraints, and what counts as moved
};

// Where positions lie between load and store: x, y and z of vertex i are the first numbers of row place[i]. Rows have
// `stride` numbers.
template <typename Scalar>
struct PositionRows {
    Scalar* data;
    int stride;
    std::vector<int> place;  // #V
};

// One mesh's constraints, with its positions between load and store. Scalar: float or double.
template <typename Scalar>
class Projection {
public:
    virtual ~Projection() = default;

    // p: positions, q: posed bind points [m], #V x 3; inside, positions are relative to origin [m].
    virtual void load(const Positions& p, const Positions& q, const Vec3& origin) = 0;
    virtual void project_bind_constraints() = 0;     // line 11: all of the class once, Sec. 3.6
    virtual void project_stretch_constraints() = 0;  // line 12, Eq. 10
    virtual void project_volume_constraints() = 0;   // line 13, Eq. 11
    // Positions back in p [m], #V x 3; origin as it was given to load.
    virtual void store(const Vec3& origin, Positions& p) const = 0;

    virtual PositionRows<Scalar> rows() = 0;

    virtual Residuals residuals() const = 0;  // of the positions as they are now, summed in double

    // Constraints far from any that the loaded positions leave unsatisfied, and from what moved in the last step, sleep
    // from now on. Where options.sleep is not set, and in an order that knows no sleep, nothing sleeps.
    virtual void sleep(const SleepTolerance&) {}
    // Wakes what is unsatisfied now and those around it; how many vertices had been asleep there. None: remembers what
    // moved.
    virtual int wake(const SleepTolerance&) { return 0; }
    virtual double sleeping_share() const { return 0.0; }  // of stretch and volume constraints
};

// The order that options.order names. InputError where it does not know what is asked for: Eq. 12-20 as printed are
// written in `plain` alone, which lets nothing sleep.
template <typename Scalar>
std::unique_ptr<Projection<Scalar>> make_projection(ConstraintSet<Scalar> constraints, const Tets& tets,
                                                    const PbsOptions& options);

}  // namespace pbs
