// How flesh answers a deformation gradient F: energy density, stress and tangent of an isotropic law.
//   const auto law = constitutive_law(Model::stable_neo_hookean, lame_parameters(young_pa, poisson));
//   const PointResponse response = law->evaluate(F, Derivatives::second);
//   first_piola_kirchhoff(response, law->lambda_pa());
// Every law is written in two parts, psi(F) = shape(F) + lambda / 2 theta(F)^2, where the dilatation theta is the law's
// own measure of the change of volume. The mean dilatation formulation then replaces theta by its mean over the tet,
// for each law alike. All have the small-strain limit of linear elasticity with the same Lame parameters.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/options.hpp"

#include <Eigen/Core>

#include <memory>

namespace reference_fem {

using Tangent = Eigen::Matrix<double, 9, 9>;  // d vec(A) / d vec(F), vec by columns

// By F, of the energy density: none asks for psi alone, second for all.
enum class Derivatives { none, first, second };

// The requested quantities: shape [Pa], theta [1], and their derivatives by F; the rest is left as it is.
struct PointResponse {
    bool defined = true;                   // false: F is outside the law's domain (det F <= 0), nothing else is set
    double shape = 0.0, dilatation = 0.0;  // [Pa], [1]
    Eigen::Matrix3d shape_gradient, dilatation_gradient;  // d shape / d F [Pa], d theta / d F [1]
    Tangent shape_hessian, dilatation_hessian;            // [Pa], [1]; symmetric
};

// A law has no state except its parameters.
class ConstitutiveLaw {
public:
    explicit ConstitutiveLaw(const Lame& lame) : lame_(lame) {}  // not checked: lame_parameters has
    virtual ~ConstitutiveLaw() = default;

    // At any F, 3 x 3; nothing is thrown: `defined` says where the law has no value.
    virtual PointResponse evaluate(const Eigen::Matrix3d& deformation_gradient, Derivatives derivatives) const = 0;

    double lambda_pa() const { return volume_term() ? lame_.lambda_pa : 0.0; }  // the factor of theta^2 / 2
    // false: the law is not of the two-part form, theta = 0
    virtual bool volume_term() const { return true; }

protected:
    Lame lame_;  // as given
};

// Makes a law by name; the formulas are in constitutive_law.cpp.
std::unique_ptr<const ConstitutiveLaw> constitutive_law(Model model, const Lame& lame);

// psi [Pa] of a response; lambda_pa: its law's lambda_pa().
double energy_density(const PointResponse& response, double lambda_pa);
// P = d psi / d F [Pa], from a first derivative on
Eigen::Matrix3d first_piola_kirchhoff(const PointResponse& response, double lambda_pa);
// d vec P / d vec F [Pa], from a second derivative
Tangent tangent(const PointResponse& response, double lambda_pa);

// Pieces that the derivatives of the laws share. vec stacks columns, so entry (i, j) of a 3 x 3 matrix is entry 3 j + i
// of a 9-vector.
using Vector9 = Eigen::Matrix<double, 9, 1>;

inline Vector9 vec(const Eigen::Matrix3d& matrix)
{
    return Eigen::Map<const Vector9>(matrix.data());
}

// vec(A) vec(B)^T.
inline Tangent outer(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b)
{
    return vec(a) * vec(b).transpose();
}

// d det F / d F = det F  F^-T, defined for every F.
Eigen::Matrix3d cofactor(const Eigen::Matrix3d& f);
// d vec cofactor(F) / d vec F, linear in F: symmetric.
Tangent cofactor_derivative(const Eigen::Matrix3d& f);
// d vec(A D^T A) / d vec D for a fixed A: entry (ij, kl) is A_il A_kj.
Tangent transposing_product(const Eigen::Matrix3d& a);

// Changes against F = I. Near it they are sums of small terms in G = F - I, not small differences of large ones, so
// that an energy made of them is exact to rounding relative to itself.
struct Invariants {
    double volume;               // J = det F
    double volume_change;        // J - 1
    double squared_norm_change;  // |F|^2 - 3
    double shear;                // (|F|^2 - 3) / 2 - (J - 1)

    double log_volume() const;  // ln J, for J > 0
};
Invariants invariants(const Eigen::Matrix3d& f);  // of any finite F, inverted ones too

// The polar decomposition F = R S with det R = +1, by the signed singular values F = U diag(s) V^T: where det F < 0 the
// smallest is negative, so that R turns F as little as a rotation can and S takes the reflection (G. Irving, J. Teran,
// R. Fedkiw, Invertible Finite Elements for Robust Simulation of Large Deformation, SCA 2004). F = U diag(s) V^T and S
// = V diag(s) V^T.
struct PolarDecomposition {
    Eigen::Matrix3d left, right;  // U, V: orthogonal
    Eigen::Vector3d stretches;    // s, falling; the last may be negative: the eigenvalues of S
    Eigen::Matrix3d rotation;     // R = U V^T
};

// f: finite.
PolarDecomposition polar_decomposition(const Eigen::Matrix3d& f);

// d vec R / d vec F: the three twist modes (U [e_k]x V^T) / sqrt 2, each by 2 / (s_i + s_j); symmetric, not negative.
// Where s_i + s_j = 0 the rotation is not unique and jumps. There and closer than 1e-8 max(1, s_1) the sum is taken for
// that bound.
Tangent rotation_derivative(const PolarDecomposition& polar);

}  // namespace reference_fem
