#include "pbs/skinning/direct_delta_mush.hpp"

#include "pbs/geometry/input_error.hpp"
#include "pbs/geometry/nearest_rotation.hpp"
#include "pbs/geometry/topology.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>

namespace pbs {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Fields = Eigen::MatrixXd;  // functions on the vertices, #V x any number

void require(bool holds, const char* option, double value, const char* rule)
{
    if (!holds) throw InputError("direct_delta_mush", 0, option, number_text(value), rule);
}

void check(const DirectDeltaMushOptions& options)
{
    const bool is_explicit = options.smoothing == MushSmoothing::explicit_steps;
    require(options.iterations >= 0, "iterations", options.iterations, "expected 0 or more");
    require(options.lambda >= 0.0 && (!is_explicit || options.lambda <= 1.0), "lambda", options.lambda,
            "expected 0 or more, and at most 1 with explicit steps");
    require(options.kappa >= 0.0 && options.kappa <= options.lambda, "kappa", options.kappa,
            "expected 0 <= kappa <= lambda");
    require(options.alpha >= 0.0 && options.alpha <= 1.0, "alpha", options.alpha, "expected 0 <= alpha <= 1");
    require(options.negligible >= 0.0 && options.negligible <= 1e-3, "negligible", options.negligible,
            "expected 0 <= negligible <= 1e-3");
}

// X -> B^T X, the p smoothing steps of functions on the vertices.
class Smoother {
public:
    Smoother(const Adjacency& neighbours, double step, const DirectDeltaMushOptions& options)
        : step_(step),
          iterations_(step > 0.0 ? options.iterations : 0),
          is_explicit_(options.smoothing == MushSmoothing::explicit_steps)
    {
        const int vertices = static_cast<int>(neighbours.first.size()) - 1;
        degree_ = Eigen::VectorXd::Ones(vertices);  // of a vertex without neighbours: any
        std::vector<Eigen::Triplet<double>> entries;
        for (int i = 0; i < vertices; ++i) {
            const int count = neighbours.first[i + 1] - neighbours.first[i];
            if (count > 0) degree_(i) = count;
            entries.emplace_back(i, i, count);
            for (int k = neighbours.first[i]; k < neighbours.first[i + 1]; ++k)
                entries.emplace_back(i, neighbours.neighbour[k], -1.0);
        }
        laplacian_.resize(vertices, vertices);
        laplacian_.setFromTriplets(entries.begin(), entries.end());
        if (is_explicit_ || iterations_ == 0) return;
        Sparse system = step_ * laplacian_;  // (D + lambda L) X' = D X, the transpose of 1 + lambda L D^-1 times D
        system.diagonal() += degree_;
        factor_.compute(system);
    }

    Fields operator()(Fields fields) const
    {
        for (int iteration = 0; iteration < iterations_; ++iteration)
            if (is_explicit_) {
                const Fields differences = laplacian_ * fields;
                fields -= step_ * (degree_.cwiseInverse().asDiagonal() * differences);
            } else {
                const Fields right_hand_sides = degree_.asDiagonal() * fields;
                fields = factor_.solve(right_hand_sides);
            }
        return fields;
    }

private:
    double step_;
    int iterations_;
    bool is_explicit_;
    Eigen::VectorXd degree_;
    Sparse laplacian_;
    Eigen::SimplicialLDLT<Sparse> factor_;
};

// The weights of the bone, #V x 1.
Fields weights_of(int bone, const Weights& weights)
{
    Fields result = Fields::Zero(weights.vertices(), 1);
    for (int v = 0; v < weights.vertices(); ++v)
        for (int k = weights.first[v]; k < weights.first[v + 1]; ++k)
            if (weights.bone[k] == bone) result(v, 0) += weights.weight[k];
    return result;
}

// 1; x, y, z; xx, xy, xz, yy, yz, zz of the points, #V x 10.
Fields monomials_of(const Positions& points)
{
    Fields result(points.rows(), 10);
    result.col(0).setOnes();
    result.middleCols<3>(1) = points;
    int column = 4;
    for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) result.col(column++) = points.col(a).cwiseProduct(points.col(b));
    return result;
}

// Psi_ij of a bone and a vertex, about the origin of the points.
struct RawMoments {
    int bone;
    double blended;  // w'_ij
    Eigen::Matrix<double, 10, 1> psi;
};

using RawRows = std::vector<std::vector<RawMoments>>;  // of each vertex

RawRows raw_moments(const Positions& points, const Weights& weights, const Smoother& by_lambda,
                    const Smoother& by_kappa, double negligible)
{
    RawRows rows(points.rows());
    const Fields monomials = monomials_of(points);
    const int bones = weights.bone.empty() ? 0 : *std::ranges::max_element(weights.bone) + 1;
    for (int bone = 0; bone < bones; ++bone) {
        const Fields own = weights_of(bone, weights);
        if (own.isZero(0.0)) continue;
        const Fields blended = by_kappa(own), psi = by_lambda(own.col(0).asDiagonal() * monomials);
        for (Eigen::Index v = 0; v < points.rows(); ++v)
            if (std::max(psi(v, 0), blended(v, 0)) > negligible)
                rows[v].push_back({bone, std::max(blended(v, 0), 0.0), psi.row(v).transpose()});
    }
    return rows;
}

// About `centre` instead of the origin.
DirectDeltaMush::Moments centred(const RawMoments& raw, double scale, const Vec3& centre)
{
    const Eigen::Matrix<double, 10, 1> psi = scale * raw.psi;
    const Vec3 about_origin = psi.segment<3>(1);
    DirectDeltaMush::Moments result{raw.bone, psi(0), about_origin - psi(0) * centre, {}};
    result.second << psi(4), psi(5), psi(6), psi(5), psi(7), psi(8), psi(6), psi(8), psi(9);
    result.second -= about_origin * centre.transpose() + centre * result.first.transpose();
    return result;
}

template <class Scalar>
BoneMoments<Scalar> packed(const DirectDeltaMush::Moments& moments, double alpha)
{
    BoneMoments<Scalar> result = {};
    int entry = 0;
    for (int a = 0; a < 3; ++a) {
        result.first[a] = static_cast<Scalar>(moments.first(a));
        result.share[a] = static_cast<Scalar>((1.0 - alpha) * moments.first(a));
        for (int b = a; b < 3; ++b) result.second[entry++] = static_cast<Scalar>(moments.second(a, b));
    }
    result.weight = static_cast<Scalar>(moments.weight);
    result.bone = moments.bone;
    return result;
}

}  // namespace

DirectDeltaMush::DirectDeltaMush(const TetMesh& mesh, const Weights& weights, const DirectDeltaMushOptions& options)
    : options_(options)
{
    check(options);
    const Adjacency neighbours = adjacency_of(mesh.tets, static_cast<int>(mesh.rest.rows()));
    const Vec3 middle = middle_of_box(mesh.rest);
    const Positions points = mesh.rest.rowwise() - middle.transpose();
    const RawRows rows = raw_moments(points, weights, Smoother(neighbours, options.lambda, options),
                                     Smoother(neighbours, options.kappa, options), options.negligible);
    centre_ = detail_ = mesh.rest;
    first_.push_back(0);
    for (Eigen::Index v = 0; v < mesh.rest.rows(); ++v) {
        double sum = 0.0, blended = 0.0;
        Vec3 first = Vec3::Zero();
        for (const RawMoments& raw : rows[v]) {
            sum += raw.psi(0);
            blended += raw.blended;
            first += raw.psi.segment<3>(1);
        }
        const Vec3 centre = first / sum;
        for (const RawMoments& raw : rows[v]) {
            moments_.push_back(centred(raw, 1.0 / sum, centre));
            moments_.back().weight = (1.0 - options.alpha) * raw.psi(0) / sum + options.alpha * raw.blended / blended;
        }
        centre_.row(v) = (centre + middle).transpose();
        detail_.row(v) = points.row(v) - centre.transpose();
        first_.push_back(static_cast<int>(moments_.size()));
    }
}

void DirectDeltaMush::apply(const Pose& pose, Positions& posed) const
{
    posed.resize(centre_.rows(), 3);
    for (Eigen::Index v = 0; v < centre_.rows(); ++v) {
        // sum_j first_j = 0: any origin
        const Vec3 centre = centre_.row(v), origin = pose[moments_[first_[v]].bone] * centre;
        Vec3 q = origin;
        Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
        for (int k = first_[v]; k < first_[v + 1]; ++k) {
            const Moments& moments = moments_[k];
            const Vec3 moved = pose[moments.bone] * centre - origin;
            q += moments.weight * moved + (1.0 - options_.alpha) * (pose[moments.bone].linear() * moments.first);
            covariance += pose[moments.bone].linear() * moments.second + moved * moments.first.transpose();
        }
        posed.row(v) = (q + nearest_rotation(covariance) * detail_.row(v).transpose()).transpose();
    }
}

template <class Scalar>
PackedDirectMush<Scalar>::PackedDirectMush(const TetMesh& mesh, const Weights& weights,
                                           const DirectDeltaMushOptions& options)
    : posed_(mesh.rest.size()), refused_(mesh.rest.rows()), middle_(middle_of_box(mesh.rest))
{
    const DirectDeltaMush plain(mesh, weights, options);
    first_ = plain.first();
    int bones = 0;
    for (const DirectDeltaMush::Moments& moments : plain.moments()) {
        moments_.push_back(packed<Scalar>(moments, options.alpha));
        bones = std::max(bones, moments.bone + 1);
    }
    bones_.resize(bones);
    centre_ = padded_rows<Scalar>(plain.centre(), middle_, 1);
    detail_ = padded_rows<Scalar>(plain.detail(), Vec3::Zero());
}

template <class Scalar>
const std::vector<Scalar>& PackedDirectMush<Scalar>::apply_rows(const Pose& pose, const Vec3& origin)
{
    for (std::size_t bone = 0; bone < bones_.size(); ++bone) {
        Eigen::Isometry3d placed = pose[bone];
        placed.translation() = pose[bone] * middle_ - origin;
        Eigen::Map<Eigen::Matrix<Scalar, 4, 4>> matrix(bones_[bone].numbers);
        matrix = placed.matrix().template cast<Scalar>();
    }
    const MomentRows<Scalar> rows{static_cast<int>(first_.size()) - 1, first_.data(), moments_.data(), centre_.data(),
                                  detail_.data()};
    RefusedRotations<Scalar> refused = refused_.none_yet();
    move_by_moments(rows, bones_.data(), posed_.data(), refused);
    PackedRotations<Scalar>::turn(refused, detail_, posed_);
    return posed_;
}

template <class Scalar>
void PackedDirectMush<Scalar>::apply(const Pose& pose, Positions& posed)
{
    const Vec3 origin = posed_origin(pose, middle_);
    to_world(apply_rows(pose, origin), origin, posed);
}

template class PackedDirectMush<float>;
template class PackedDirectMush<double>;

}  // namespace pbs
