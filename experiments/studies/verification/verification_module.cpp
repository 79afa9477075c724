#include "experiments/studies/verification/problem.hpp"

const std::vector<experiments::VerificationProblem>* pbskin_verification_problems()
{
    return &experiments::verification_problems();
}
