#include "pbs/skinning/correctives.hpp"

#include "pbs/geometry/input_error.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pbs {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int rotation_features = 25, parent_features = corrective_features - rotation_features;
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double least_tried_strength = 1e-12;  // over the largest squared singular value
constexpr double better = 1.0 - 1e-9;           // less is no improvement but rounding
constexpr double least_feature = 1e-9;          // of a joint that turns; below it is rounding
constexpr double added_share = 0.05;            // of the mean squared residual, in the weights of the samples

void require_option(bool holds, const char* option, double value, const char* rule)
{
    if (!holds) throw InputError("correctives", 0, option, number_text(value), rule);
}

// R - 1 column by column, then xx, xy, xz, yy, yz, zz and xxx, xxy, xxz, xyy and so on of the rotation vector.
Eigen::Matrix<double, 1, rotation_features> features_of_rotation(const Eigen::Matrix3d& rotation)
{
    const Eigen::AngleAxisd turn(rotation);
    const Vec3 w = turn.angle() * turn.axis();
    Eigen::Matrix<double, 1, rotation_features> features;
    features.head<9>() = (rotation - Eigen::Matrix3d::Identity()).reshaped().transpose();
    int quadratic = 9, cubic = parent_features;
    for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) {
            features(quadratic++) = w(a) * w(b);
            for (int c = b; c < 3; ++c) features(cubic++) = w(a) * w(b) * w(c);
        }
    return features;
}

// The vertices that the bone or its parent moves.
std::vector<int> support_of(int bone, int parent, const Weights& weights)
{
    std::vector<int> vertices;
    for (int v = 0; v < weights.vertices(); ++v)
        if (weights.of(v, bone) != 0.0 || weights.of(v, parent) != 0.0) vertices.push_back(v);
    return vertices;
}

// The columns of x, y, z of the vertices, which lie side by side.
std::vector<int> columns_of(const std::vector<int>& vertices)
{
    std::vector<int> columns;
    for (const int v : vertices)
        for (int axis = 0; axis < 3; ++axis) columns.push_back(3 * v + axis);
    return columns;
}

// The inverse of a matrix whose singular values below `least` count as `least`.
Eigen::Matrix3d bounded_inverse(const Eigen::Matrix3d& matrix, double least)
{
    const Eigen::JacobiSVD<MatrixXd> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const VectorXd inverse = svd.singularValues().cwiseMax(least).cwiseInverse();
    return svd.matrixV() * inverse.asDiagonal() * svd.matrixU().transpose();
}

// The vertices that the fit, #samples x 3 #vertices, moves farthest in some sample by at least this share of the
// largest such distance.
std::vector<int> moved_vertices(const std::vector<int>& vertices, const MatrixXd& fit, double negligible)
{
    VectorXd largest(static_cast<Eigen::Index>(vertices.size()));
    for (Eigen::Index i = 0; i < largest.size(); ++i) largest(i) = fit.middleCols<3>(3 * i).rowwise().norm().maxCoeff();
    std::vector<int> moved;
    for (Eigen::Index i = 0; i < largest.size(); ++i)
        if (largest(i) >= negligible * largest.maxCoeff()) moved.push_back(vertices[i]);
    return moved;
}

// A joint, and what its regression needs in every sweep.
class JointFit {
public:
    // roots: sqrt(w_p) of the samples. residuals: r of the samples times these, #samples x 3 #V. They determine the
    // strength and the vertices.
    JointFit(int joint, const std::vector<int>& support, MatrixXd features, const VectorXd& roots,
             const CorrectiveOptions& options, const RowMajorMatrix& residuals)
        : joint_{.joint = joint},
          options_(options),
          features_(std::move(features)),
          roots_(roots),
          ridge_(roots.asDiagonal() * features_)
    {
        const MatrixXd targets = residuals(Eigen::all, columns_of(support));
        strength_ = ridge_.best_strength(targets, options.least_strength);
        if (!std::isfinite(strength_)) return;
        joint_.vertices =
            moved_vertices(support, features_ * ridge_.coefficients(targets, strength_), options.negligible);
        columns_ = columns_of(joint_.vertices);
        joint_.modes = MatrixXd::Zero(static_cast<Eigen::Index>(columns_.size()), 0);
        joint_.drivers = MatrixXd::Zero(0, features_.cols());
    }

    // Fits it anew to what the other joints have left of the residuals.
    void sweep(RowMajorMatrix& residuals)
    {
        const MatrixXd targets = MatrixXd(residuals(Eigen::all, columns_)) + fit();
        const MatrixXd coefficients = ridge_.coefficients(targets, strength_);
        const Eigen::BDCSVD<MatrixXd> svd = ridge_.modes(coefficients, strength_);
        Eigen::Index rank = 0;
        while (rank < std::min<Eigen::Index>(options_.rank, svd.singularValues().size()) &&
               svd.singularValues()(rank) > 0.0 &&
               svd.singularValues()(rank) >= options_.negligible * svd.singularValues()(0))
            ++rank;
        const MatrixXd orthonormal = svd.matrixV().leftCols(rank), drivers = coefficients * orthonormal;
        const MatrixXd samples = features_ * drivers;  // a column per mode
        const Eigen::RowVectorXd largest = samples.cwiseAbs().colwise().maxCoeff();
        const MatrixXd scaled = samples * largest.cwiseInverse().asDiagonal();
        joint_.modes = orthonormal * largest.asDiagonal();
        joint_.drivers = largest.cwiseInverse().asDiagonal() * drivers.transpose();
        joint_.lowest = scaled.colwise().minCoeff().cwiseMin(0.0);
        joint_.highest = scaled.colwise().maxCoeff().cwiseMax(0.0);
        residuals(Eigen::all, columns_) = targets - fit();
    }

    bool is_any() const { return !columns_.empty(); }
    const JointCorrective& joint() const { return joint_; }

private:
    MatrixXd fit() const  // #samples x 3 #vertices, times the roots
    {
        return roots_.asDiagonal() * (features_ * joint_.drivers.transpose()) * joint_.modes.transpose();
    }

    JointCorrective joint_;
    CorrectiveOptions options_;
    MatrixXd features_;
    VectorXd roots_;
    RidgeRegression ridge_;
    double strength_ = 0.0;
    std::vector<int> columns_;
};

}  // namespace

Eigen::Index Correctives::modes() const
{
    Eigen::Index sum = 0;
    for (const JointCorrective& joint : joints) sum += joint.drivers.rows();
    return sum;
}

RidgeRegression::RidgeRegression(const MatrixXd& features) : svd_(features, Eigen::ComputeThinU | Eigen::ComputeThinV)
{
}

VectorXd RidgeRegression::shares(double strength) const
{
    const auto squares = svd_.singularValues().array().square();
    const double smallest =
        std::numeric_limits<double>::epsilon() * static_cast<double>(std::max(svd_.rows(), svd_.cols()));
    return (svd_.singularValues().array() <= smallest * svd_.singularValues()(0))
        .select(0.0, squares / (squares + strength));
}

MatrixXd RidgeRegression::coefficients(const MatrixXd& targets, double strength) const
{
    const VectorXd kept = shares(strength);
    const VectorXd inverse = (kept.array() > 0.0).select(kept.array() / svd_.singularValues().array(), 0.0);
    return svd_.matrixV() * (inverse.asDiagonal() * (svd_.matrixU().transpose() * targets));
}

double RidgeRegression::left_out_error(const MatrixXd& targets, double strength) const
{
    const VectorXd kept = shares(strength);
    const MatrixXd errors = targets - svd_.matrixU() * (kept.asDiagonal() * (svd_.matrixU().transpose() * targets));
    const VectorXd others = 1.0 - (svd_.matrixU().cwiseAbs2() * kept).array();  // 1 - h_i
    if (others.minCoeff() <= 1e-9) return infinite;
    return (errors.rowwise().squaredNorm().array() / others.array().square()).sum();
}

double RidgeRegression::best_strength(const MatrixXd& targets, double least) const
{
    double best = infinite, least_error = targets.squaredNorm();
    const double largest = svd_.singularValues()(0) * svd_.singularValues()(0);
    const auto attempt = [&](double strength) {
        const double error = left_out_error(targets, strength);
        if (!(error < better * least_error)) return;
        least_error = error;
        best = strength;
    };
    for (double share = 1.0; share >= std::max(0.99 * least, least_tried_strength); share *= 0.1)
        attempt(share * largest);
    if (least == 0.0) attempt(0.0);
    return best;
}

Eigen::BDCSVD<MatrixXd> RidgeRegression::modes(const MatrixXd& coefficients, double strength) const
{
    const VectorXd roots = (svd_.singularValues().array().square() + strength).sqrt();
    const MatrixXd rotated = roots.asDiagonal() * (svd_.matrixV().transpose() * coefficients);
    return {rotated, Eigen::ComputeThinU | Eigen::ComputeThinV};
}

CorrectiveFeatures corrective_features_of(const std::vector<int>& parents, const Pose& pose)
{
    CorrectiveFeatures features =
        CorrectiveFeatures::Zero(static_cast<Eigen::Index>(parents.size()), corrective_features);
    for (std::size_t bone = 0; bone < parents.size(); ++bone) {
        if (parents[bone] < 0) continue;
        const Eigen::Matrix3d rotation = pose[parents[bone]].linear().transpose() * pose[bone].linear();
        features.row(bone).head<rotation_features>() = features_of_rotation(rotation);
        features.row(bone).tail<parent_features>() = features.row(parents[bone]).head<parent_features>();
    }
    return features;
}

Positions rest_residual(const Positions& rest, const Weights& weights, const CorrectiveSample& sample,
                        double least_stretch)
{
    Positions residual;
    linear_blend_skinning(rest, weights, sample.pose, residual);
    residual = sample.shape - residual;
    for (int v = 0; v < weights.vertices(); ++v) {
        Eigen::Matrix3d blended = Eigen::Matrix3d::Zero();
        for (int e = weights.first[v]; e < weights.first[v + 1]; ++e)
            blended += weights.weight[e] * sample.pose[weights.bone[e]].linear();
        Eigen::Matrix3d inverse = blended.inverse();
        if (!(inverse.norm() * least_stretch <= 1.0)) inverse = bounded_inverse(blended, least_stretch);
        residual.row(v) = (inverse * residual.row(v).transpose()).transpose();
    }
    return residual;
}

VectorXd sample_weights(const VectorXd& squared_residuals)
{
    const double floor = squared_residuals.size() > 0 ? added_share * squared_residuals.mean() : 0.0;
    if (!(floor > 0.0)) return VectorXd::Ones(squared_residuals.size());
    return (squared_residuals.array() + floor).inverse();
}

Correctives fit_correctives(const Skeleton& skeleton, const Positions& rest, const Weights& weights,
                            const std::vector<CorrectiveSample>& samples, const CorrectiveOptions& options)
{
    require_option(options.rank >= 1, "rank", options.rank, "expected 1 or more");
    require_option(options.sweeps >= 1, "sweeps", options.sweeps, "expected 1 or more");
    require_option(options.least_strength >= 0.0 && options.least_strength <= 1.0, "least_strength",
                   options.least_strength, "expected a number from 0 to 1");
    require_option(options.least_stretch > 0.0 && options.least_stretch <= 1.0, "least_stretch", options.least_stretch,
                   "expected a number above 0, at most 1");
    require_option(options.negligible >= 0.0 && options.negligible < 1.0, "negligible", options.negligible,
                   "expected a number from 0, below 1");
    for (const CorrectiveSample& sample : samples)
        if (sample.shape.rows() != rest.rows() || !sample.shape.allFinite())
            throw InputError("correctives", 0, "samples", std::to_string(sample.shape.rows()) + " points",
                             "expected " + std::to_string(rest.rows()) + " finite points");
    Correctives correctives;
    correctives.vertices = static_cast<int>(rest.rows());
    for (const Bone& bone : skeleton.bones) correctives.parents.push_back(bone.parent);
    const auto count = static_cast<Eigen::Index>(samples.size()),
               bones = static_cast<Eigen::Index>(skeleton.bones.size());
    correctives.lowest = correctives.highest = CorrectiveFeatures::Zero(bones, corrective_features);
    RowMajorMatrix residuals(count, rest.size());
    std::vector<MatrixXd> features(bones, MatrixXd(count, corrective_features));  // of each joint
    for (Eigen::Index s = 0; s < count; ++s) {
        const Positions residual = rest_residual(rest, weights, samples[s], options.least_stretch);
        residuals.row(s) = Eigen::Map<const Eigen::RowVectorXd>(residual.data(), residual.size());
        const CorrectiveFeatures rows = corrective_features_of(correctives.parents, samples[s].pose);
        correctives.lowest = correctives.lowest.cwiseMin(rows);
        correctives.highest = correctives.highest.cwiseMax(rows);
        for (Eigen::Index bone = 0; bone < bones; ++bone) features[bone].row(s) = rows.row(bone);
    }
    const VectorXd roots = sample_weights(residuals.rowwise().squaredNorm()).cwiseSqrt();
    residuals = roots.asDiagonal() * residuals;
    std::vector<JointFit> fits;
    for (int bone = 0; bone < bones; ++bone) {
        const bool turns = count > 0 && features[bone].cwiseAbs().maxCoeff() > least_feature;
        if (!turns) continue;
        const std::vector<int> support = support_of(bone, correctives.parents[bone], weights);
        if (support.empty()) continue;
        JointFit fit(bone, support, features[bone], roots, options, residuals);
        if (!fit.is_any()) continue;
        fits.push_back(std::move(fit));
        fits.back().sweep(residuals);
    }
    for (int sweep = 1; sweep < options.sweeps; ++sweep)
        for (JointFit& fit : fits) fit.sweep(residuals);
    for (const JointFit& fit : fits) correctives.joints.push_back(fit.joint());
    return correctives;
}

VectorXd corrective_coefficients(const Correctives& correctives, const Pose& pose)
{
    VectorXd coefficients(correctives.modes());
    const CorrectiveFeatures features = corrective_features_of(correctives.parents, pose);
    Eigen::Index first = 0;
    for (const JointCorrective& joint : correctives.joints) {
        const VectorXd own = joint.drivers * features.row(joint.joint).transpose();
        coefficients.segment(first, own.size()) = own.cwiseMax(joint.lowest).cwiseMin(joint.highest);
        first += own.size();
    }
    return coefficients;
}

bool is_within_training(const Correctives& correctives, const Pose& pose)
{
    const CorrectiveFeatures features = corrective_features_of(correctives.parents, pose);
    return (features.array() >= correctives.lowest.array() - least_feature).all() &&
           (features.array() <= correctives.highest.array() + least_feature).all();
}

Positions corrective_displacements(const Correctives& correctives, const Pose& pose)
{
    const VectorXd coefficients = corrective_coefficients(correctives, pose);
    Positions displacements = Positions::Zero(correctives.vertices, 3);
    Eigen::Index first = 0;
    for (const JointCorrective& joint : correctives.joints) {
        const VectorXd moved = joint.modes * coefficients.segment(first, joint.modes.cols());
        for (std::size_t i = 0; i < joint.vertices.size(); ++i)
            displacements.row(joint.vertices[i]) += moved.segment<3>(3 * i).transpose();
        first += joint.modes.cols();
    }
    return displacements;
}

void corrected_skinning(const Correctives& correctives, const Positions& rest, const Weights& weights, const Pose& pose,
                        Positions& posed)
{
    linear_blend_skinning(rest + corrective_displacements(correctives, pose), weights, pose, posed);
}

template <class Scalar>
CorrectiveSkinning<Scalar>::CorrectiveSkinning(const Correctives& correctives, const Positions& rest,
                                               const Weights& weights)
    : correctives_(correctives),
      skinning_(rest, weights),
      rest_(skinning_.rest_rows(), skinning_.rest_rows() + rest.size())
{
    for (JointCorrective& joint : correctives_.joints) {
        modes_.push_back(joint.modes.template cast<Scalar>());
        joint.modes.resize(0, 0);
    }
}

template <class Scalar>
void CorrectiveSkinning<Scalar>::apply(const Pose& pose, Positions& posed)
{
    const Vector coefficients = corrective_coefficients(correctives_, pose).template cast<Scalar>();
    Scalar* displaced = skinning_.rest_rows();
    std::ranges::copy(rest_, displaced);
    Eigen::Index first = 0;
    for (std::size_t j = 0; j < modes_.size(); ++j) {
        moved_.noalias() = modes_[j] * coefficients.segment(first, modes_[j].cols());
        const Scalar* moved = moved_.data();
        for (const int v : correctives_.joints[j].vertices)
            for (int axis = 0; axis < 3; ++axis) displaced[3L * v + axis] += *moved++;
        first += modes_[j].cols();
    }
    skinning_.linear(pose, posed);
}

template class CorrectiveSkinning<float>;
template class CorrectiveSkinning<double>;

}  // namespace pbs
