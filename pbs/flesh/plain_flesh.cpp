#include "pbs/flesh/flesh_system.hpp"

#include "pbs/packed/rows.hpp"

#include <numeric>

namespace pbs {

template <typename Energy>
PlainSystem<Energy>::PlainSystem(const Energy& energy, const CholeskyFactor& factor)
    : energy_(energy), factor_(factor), place_(static_cast<std::size_t>(energy.hold().size()))
{
    std::iota(place_.begin(), place_.end(), 0);
}

template <typename Energy>
void PlainSystem<Energy>::load(const Positions& x, Rows<double>& rows) const
{
    load_rows(x, place_, Vec3::Zero(), rows);
}

template <typename Energy>
void PlainSystem<Energy>::store(const Rows<double>& rows, Positions& x) const
{
    store_rows(rows, place_, Vec3::Zero(), x);
}

template <typename Energy>
double PlainSystem<Energy>::value_and_gradient(const Rows<double>& x, Rows<double>& gradient)
{
    store(x, x_);
    const double value = energy_.value_and_gradient(x_, centres_, gradient_);
    load(gradient_, gradient);
    return value;
}

template <typename Energy>
void PlainSystem<Energy>::precondition(Rows<double>& residual)
{
    solve_plainly(factor_, place_, residual.data(), work_);
}

template <typename Energy>
double PlainSystem<Energy>::dot(const Rows<double>& a, const Rows<double>& b) const
{
    double sum = 0.0;
    for (int i = 0; i < static_cast<int>(place_.size()); ++i)
        for (int axis = 0; axis < 3; ++axis) sum += a[i][axis] * b[i][axis];
    return sum;
}

template <typename Energy>
void PlainSystem<Energy>::add(double factor, const Rows<double>& a, Rows<double>& to) const
{
    for (int i = 0; i < static_cast<int>(place_.size()); ++i)
        for (int axis = 0; axis < 3; ++axis) to[i][axis] += factor * a[i][axis];
}

template <typename Energy>
std::size_t PlainSystem<Energy>::bytes() const
{
    return energy_.tets().size() * sizeof(energy_.tets()[0]) + 2 * (sizeof(double) + sizeof(int)) * factor_.value.size();
}

template class PlainSystem<FleshEnergy>;
template class PlainSystem<ProjectiveEnergy>;

}  // namespace pbs
