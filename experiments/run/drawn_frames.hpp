// A program that draws the frames of a run reads these tables with them: the bones and the binding of the vertices
// (bones.csv, bones_rest.csv, binding.csv), the surface that the tets carry (surface_rest.vtp, embedding.csv), and the
// distances between the deformers (distances.csv).
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/characters/character.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "pbs/skinning/pose.hpp"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace experiments {

struct BonePlace {
    std::string bone, parent;
    pbs::Vec3 head, tail;  // [m]
};
struct PosedBone {
    int frame = 0;
    double time_s = 0.0;
    BonePlace place;
};
struct BoundVertex {
    int vertex = 0;
    std::string bone;
    double parameter = 0.0, rest_distance_m = 0.0;
    bool blended = false, jiggles = false;
};

extern const analysis::Columns<BonePlace> bone_columns;  // bones_rest.csv
// bones.csv: every bone in each frame that is written
extern const analysis::Columns<PosedBone> posed_bone_columns;
extern const analysis::Columns<BoundVertex> bound_vertex_columns;  // binding.csv

std::vector<BonePlace> bones_at_rest(const pbs::Skeleton& skeleton);
void add_bones(std::vector<PosedBone>& bones, int frame, double time_s, const pbs::Skeleton& skeleton,
               const pbs::Pose& pose);
std::vector<BoundVertex> bound_vertices(const pbs::Character& character);

// The rendered surface of a run's frames and the tets that carry it, for programs that move the surface with the tets:
//   surface_rest.vtp   the surface at rest [m]
//   embedding.csv      the tet that carries each of its points, with the point's barycentric coordinates, and the share
//                      by which its joints carry it instead (ArtistSkin::of_joints)
struct EmbeddedPoint {
    int point = 0, tet = 0;
    std::array<double, 4> barycentric = {};  // their sum is one; for a point outside its tet some are negative
    double joint_share = 0.0;                // 0 to 1
};
extern const analysis::Columns<EmbeddedPoint> embedding_columns;

using JointShares = std::vector<std::pair<int, double>>;  // of points
analysis::CsvTable embedding_table(const pbs::EmbeddedSurface& surface, const JointShares& of_joints = {});

// Writes both files into the folder of a run.
void write_surface(const pbs::EmbeddedSurface& surface, const pbs::TetMesh& mesh, const JointShares& of_joints,
                   const std::string& folder);

// distances.csv: the distances between the points that two deformers give. One row per written frame and pair of
// deformers.
//   DistanceRecord record;
//   record.add(frame, time_s, "pbs", "mesh", positions);
//   record.table().write("distances.csv");
struct DeformerDistance {
    int frame = 0;
    double time_s = 0.0;
    std::string deformer, other, of;
    int points = 0;
    double rms_mm = 0.0, largest_mm = 0.0;
};
extern const analysis::Columns<DeformerDistance> distance_columns;

class DistanceRecord {
public:
    // points [m]: #P x 3, with the same #P for all deformers of a frame. owner: what the points belong to.
    void add(int frame, double time_s, const std::string& label, const std::string& owner,
             const pbs::Positions& points);

    analysis::CsvTable table() const { return table_of(distance_columns, distances_); }

private:
    int frame_ = -1;
    std::vector<std::pair<std::string, pbs::Positions>> before_;  // of this frame
    std::vector<DeformerDistance> distances_;
};

}  // namespace experiments
