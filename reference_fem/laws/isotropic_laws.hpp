// The laws behind constitutive_law(), a file each.
#pragma once

#include "reference_fem/laws/constitutive_law.hpp"

namespace reference_fem {

std::unique_ptr<const ConstitutiveLaw> linear_law(const Lame& lame);
std::unique_ptr<const ConstitutiveLaw> corotational_law(const Lame& lame);
std::unique_ptr<const ConstitutiveLaw> stable_neo_hookean_law(const Lame& lame);
std::unique_ptr<const ConstitutiveLaw> neo_hookean_law(const Lame& lame);
std::unique_ptr<const ConstitutiveLaw> st_venant_kirchhoff_law(const Lame& lame);
std::unique_ptr<const ConstitutiveLaw> isochoric_neo_hookean_law(const Lame& lame);

}  // namespace reference_fem
