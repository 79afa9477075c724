#include "reference_fem/verification/common.hpp"

#include <cctype>
#include <cmath>

namespace reference_fem {

ElasticMaterial solver_material(const Effort& effort, const ElasticMaterial& material)
{
    if (effort.lambda_error == 0.0) return material;
    const Lame lame = lame_parameters(material.young_pa, material.poisson);
    const double lambda = (1.0 + effort.lambda_error) * lame.lambda_pa, mu = lame.mu_pa;
    return {mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu), lambda / (2.0 * (lambda + mu))};
}

RowElements elements_of(int order, Formulation formulation)
{
    if (formulation == Formulation::mean_dilatation) return {order, "mean_dilatation"};
    if (formulation == Formulation::taylor_hood) return {order, "taylor_hood"};
    return {order, "displacement"};
}

RowMaterial material_of(const std::string& law, double poisson)
{
    return {law, poisson};
}

std::string identifier_of(const std::string& words)
{
    std::string identifier;
    for (const unsigned char letter : words) {
        const bool kept = std::isalnum(letter) || letter == '.' || letter == '-';
        if (kept || !identifier.ends_with('_')) identifier += kept ? static_cast<char>(std::tolower(letter)) : '_';
    }
    return identifier;
}

RowMaterial linear_material(double poisson)
{
    return material_of("linear", poisson);
}

double order_between(double coarse, double fine)
{
    return std::log2(std::abs(coarse) / std::abs(fine));
}

void bound_by_grade_a(VerificationRow& row)
{
    row.low = row.reference - grade_a * std::abs(row.reference);
    row.high = row.reference + grade_a * std::abs(row.reference);
    row.bound_from = grade_a_text;
}

}  // namespace reference_fem
