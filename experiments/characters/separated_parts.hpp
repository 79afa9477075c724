// Parts of a model that its skeleton moves apart, and the cut of the flesh between them.
//   const SeparatedFlesh flesh = separate_parts(mesh, SkinParts(body, poses), skeleton);
#pragma once

#include "experiments/characters/character.hpp"
#include "experiments/characters/model_character.hpp"

#include <functional>
#include <queue>
#include <unordered_map>
#include <utility>
#include <vector>

namespace pbs {

// The mesher's wrap closes narrow gaps. Parts that touch or nearly touch at rest, such as two shoes or the jaws, become
// one piece of flesh, although the artist moves them independently of each other. Two points of the artist's surface
// are *apart* if
// - the skeleton moves one away from the other by more than `least_apart` of the body's diagonal, in one of the poses
//   or when a joint turns by 30 degrees, and
// - the way between them along the surface is more than three times as long as the straight one, or there is none.
// The second condition keeps a joint whole, at which the skin is continuous.
class SkinParts {
public:
    static constexpr double least_apart = 0.01;  // half of the error above which a trial warns

    SkinParts(const RiggedBody& body, std::vector<Pose> poses);  // the body outlives it

    SurfacePoint nearest(const Vec3& point, const std::function<bool(const SurfacePoint&)>& is_wanted = {}) const
    {
        return tree_.nearest(point, is_wanted);
    }
    SurfacePoint at_vertex(Eigen::Index vertex) const;  // of the surface; no triangle where none has it
    bool are_apart(const SurfacePoint& a, const SurfacePoint& b) const;
    int bone_at(const SurfacePoint& point) const;  // the one with the largest weight there
    double weight_at(const SurfacePoint& point, int bone) const;
    // The bone that moves a more than b, and the one that moves b more than a.
    std::pair<int, int> bones_between(const SurfacePoint& a, const SurfacePoint& b) const;

private:
    struct Way {
        int to;
        double length_m;
    };
    // The ways along the skin from one point, as far as they were asked for: many points are compared with the same
    // one.
    struct Ways {
        SurfacePoint from;
        std::unordered_map<int, double> least_m;  // by vertex; final below the first one of `next`
        std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> next;
    };
    Vec3 place(const SurfacePoint& point) const;
    const Ways& ways_from(const SurfacePoint& point, double longest_m) const;
    double moved_apart_m(const SurfacePoint& a, const SurfacePoint& b) const;
    bool are_near_along_skin(const SurfacePoint& a, const SurfacePoint& b) const;

    const RiggedBody& body_;
    std::vector<Pose> poses_;
    SurfaceTree tree_;
    Triangles joined_;                    // with one number for points at one place that move alike
    std::vector<std::vector<Way>> ways_;  // along the edges of the surface, by these numbers
    std::vector<int> shell_;              // of each vertex, by these numbers
    std::vector<SurfacePoint> vertices_;
    double diagonal_m_ = 0.0;
    mutable Ways last_ways_;  // not for several threads
};

// A cut between what two bones move, and its area [m^2].
struct Cut {
    int first = -1, second = -1;  // first < second
    double area_m2 = 0.0;
};

struct SeparatedFlesh {
    TetMesh mesh;  // the tets as before; vertices on both sides of a cut exist twice, the copies last
    std::vector<SurfacePoint> skin_of_tet;  // the point of the surface with which each tet moves, #T
    std::vector<Cut> cuts;                  // the largest first; none: the mesh is as before
    Eigen::VectorXi tet_at;                 // a tet that has each vertex, #V
};

// Cuts the faces between tets whose nearest points of the surface (from their centres) are apart. A piece without a
// bone inside that moves its skin is not cut off, since nothing would hold it.
SeparatedFlesh separate_parts(const TetMesh& mesh, const SkinParts& parts, const Skeleton& skeleton);

// The flesh that carries a point of the artist's surface.
struct Carrier {
    int bone = -1;       // with the largest weight of the artist at the point
    int of_flesh = -1;   // with the largest weight in the tet that carries it
    double gap_m = 0.0;  // at rest, from the point to the nearest one of the surface on which the bone of the flesh has
                         // the largest weight
};
Carrier carrier_of(const Character& character, Eigen::Index vertex);  // of a model with joints

// The tets that bones pass through, (bone, tet) at places along the bone that are at most half a tet apart, without a
// margin at each end (a share of its length).
std::vector<std::pair<int, int>> bones_in_tets(const TetMesh& mesh, const Skeleton& skeleton, double margin);

// For each part (parts_of), whether the middle half of a bone passes through it. may_count(tet, bone): only there; by
// default everywhere.
std::vector<bool> has_bone_inside(const TetMesh& mesh, const std::vector<int>& part, const Skeleton& skeleton,
                                  const std::function<bool(int, int)>& may_count = {});

}  // namespace pbs
