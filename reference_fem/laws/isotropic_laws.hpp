// The laws behind constitutive_law(), a file each.
#pragma once

#include "reference_fem/laws/constitutive_law.hpp"

namespace reference_fem {

// psi = mu eps:eps + lambda / 2 (tr eps)^2, eps = (F + F^T) / 2 - I.
std::unique_ptr<const ConstitutiveLaw> linear_law(const Lame& lame);
// psi = mu |F - R|^2 + lambda / 2 (tr S - 3)^2, F = R S (E. Sifakis, J. Barbic, SIGGRAPH 2012 courses, part I, section 3.4). Defined for
// every finite F.
std::unique_ptr<const ConstitutiveLaw> corotational_law(const Lame& lame);
// psi = mu / 2 (|F|^2 - 3) - mu (J - 1) + (lambda + mu) / 2 (J - 1)^2, J = det F (B. Smith, F. de Goes, T. Kim 2018, without their term in
// ln(|F|^2 + 1)). Defined for every F.
std::unique_ptr<const ConstitutiveLaw> stable_neo_hookean_law(const Lame& lame);
// psi = mu / 2 (|F|^2 - 3) - mu ln J + lambda / 2 (ln J)^2, J > 0 (J. Bonet, R. Wood, Eq. 6.27).
std::unique_ptr<const ConstitutiveLaw> neo_hookean_law(const Lame& lame);
// psi = mu E:E + lambda / 2 (tr E)^2, E = (F^T F - I) / 2.
std::unique_ptr<const ConstitutiveLaw> st_venant_kirchhoff_law(const Lame& lame);
// psi = kappa / 4 (J^2 - 1 - 2 ln J) + mu / 2 (J^(-2/3) |F|^2 - 3), kappa = lambda + 2 mu / 3, J > 0 (after J. Simo, T. Hughes,
// Computational Inelasticity). Not of two parts: no volume term.
std::unique_ptr<const ConstitutiveLaw> isochoric_neo_hookean_law(const Lame& lame);

}  // namespace reference_fem
