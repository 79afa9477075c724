#include "pbs/flesh/plain_flesh.hpp"

#include "pbs/flesh/positions_in_rows.hpp"
#include "pbs/flesh/triangular_solve.hpp"

#include <numeric>

namespace pbs {

PlainFlesh::PlainFlesh(const FleshEnergy& energy, const CholeskyFactor& factor)
    : energy_(energy), factor_(factor), place_(static_cast<std::size_t>(energy.hold().size()))
{
    std::iota(place_.begin(), place_.end(), 0);
}

void PlainFlesh::load(const Positions& x, Rows<double>& rows) const
{
    load_rows(x, rows);
}

void PlainFlesh::store(const Rows<double>& rows, Positions& x) const
{
    store_rows(rows, static_cast<Eigen::Index>(place_.size()), x);
}

double PlainFlesh::value_and_gradient(const Rows<double>& x, Rows<double>& gradient)
{
    store(x, x_);
    const double value = energy_.value_and_gradient(x_, centres_, gradient_);
    load(gradient_, gradient);
    return value;
}

void PlainFlesh::precondition(Rows<double>& residual)
{
    solve_plainly(factor_, place_, residual.data(), work_);
}

double PlainFlesh::dot(const Rows<double>& a, const Rows<double>& b) const
{
    double sum = 0.0;
    for (int i = 0; i < static_cast<int>(place_.size()); ++i)
        for (int axis = 0; axis < 3; ++axis) sum += a[i][axis] * b[i][axis];
    return sum;
}

void PlainFlesh::add(double factor, const Rows<double>& a, Rows<double>& to) const
{
    for (int i = 0; i < static_cast<int>(place_.size()); ++i)
        for (int axis = 0; axis < 3; ++axis) to[i][axis] += factor * a[i][axis];
}

std::size_t PlainFlesh::bytes() const
{
    return energy_.tets().size() * sizeof(FleshTet) + 2 * (sizeof(double) + sizeof(int)) * factor_.value.size();
}

}  // namespace pbs
