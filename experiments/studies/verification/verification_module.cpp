#include "experiments/studies/verification/verification_module.hpp"

const std::vector<experiments::VerificationProblem>* pbskin_verification_problems()
{
    return &experiments::verification_problems();
}
