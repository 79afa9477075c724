#include "experiments/studies/shared/constraint_sequence.hpp"

#include <random>
#include <utility>

namespace experiments {
namespace {

template <typename Constraint>
std::vector<Constraint> spread(const std::vector<Constraint>& constraints)
{
    constexpr std::size_t parts = 8;
    std::vector<Constraint> result;
    const std::size_t length = (constraints.size() + parts - 1) / parts;
    for (std::size_t i = 0; i < length; ++i)
        for (std::size_t k = i; k < constraints.size(); k += length) result.push_back(constraints[k]);
    return result;
}

// Fisher and Yates. std::shuffle may draw its numbers differently in another standard library.
template <typename Constraint>
void shuffle(std::vector<Constraint>& constraints, std::mt19937_64& engine)
{
    for (std::size_t left = constraints.size(); left > 1; --left) std::swap(constraints[left - 1], constraints[engine() % left]);
}

}  // namespace

template <typename Scalar>
void in_spread_sequence(pbs::ConstraintSet<Scalar>& constraints)
{
    constraints.stretch = spread(constraints.stretch);
    constraints.volume = spread(constraints.volume);
}

template <typename Scalar>
void in_random_sequence(pbs::ConstraintSet<Scalar>& constraints, unsigned seed)
{
    std::mt19937_64 engine(seed);
    shuffle(constraints.stretch, engine);
    shuffle(constraints.volume, engine);
}

template void in_spread_sequence(pbs::ConstraintSet<float>&);
template void in_spread_sequence(pbs::ConstraintSet<double>&);
template void in_random_sequence(pbs::ConstraintSet<float>&, unsigned);
template void in_random_sequence(pbs::ConstraintSet<double>&, unsigned);

}  // namespace experiments
