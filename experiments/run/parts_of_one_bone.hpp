// The parts of the flesh that one bone alone moves, such as a head, a hand or a hoof, and how far a frame turns them
// against their bones.
//   const PartsOfOneBone parts(character);
//   const PartLag lag = parts.largest_lag(positions, pose);
//   lag.turn_deg > 5.0: flesh that the artist tied to lag.bone does not follow it
#pragma once

#include "experiments/characters/character.hpp"
#include "pbs/skinning/pose.hpp"

#include <Eigen/Core>

#include <map>
#include <vector>

namespace experiments {

constexpr double much_lag_deg = 5.0;         // of a part
constexpr double much_lagging_share = 0.01;  // of the body: the end of a thumb decides no comparison
constexpr double most_lagging_frames = 0.1;  // in which so much lags: above, the reference is doubtful

struct PartLag {
    double turn_deg = 0.0;
    int bone = -1;  // -1: there is no such part
    int frame = -1;
    double share = 0.0;  // of the body: the volume, or the area of the artist's surface, of all parts that lag by more
                         // than much_lag_deg
};

class PartsOfOneBone {
public:
    // A part consists of the tets of pbs::bones_that_move_alone. Where such a part is thinner than two tets, only the
    // artist's surface shows it: further parts are the connected points of a rigged model that one bone alone moves, if
    // they lie in flesh that follows it too. The character outlives this.
    explicit PartsOfOneBone(const pbs::Character& character);

    // The largest angle between a bone's rotation and the one that fits its part best: the least squares over the
    // part's vertices, each weighted by its share of the part (P. Schoenemann, Psychometrika 31, 1966). positions [m],
    // #V x 3, finite. Without a frame.
    PartLag largest_lag(const pbs::Positions& positions, const pbs::Pose& pose) const;

private:
    struct Part {
        int bone;
        double size;  // a volume [m^3] or an area [m^2]
        std::vector<int> vertices;
        Eigen::Matrix3Xd arms;  // share (X - mean X) of each vertex at rest [m]
    };
    using Shares = std::map<int, double>;  // of the vertices of a part: volume [m^3], or area of the surface [m^2]

    void add_parts_of_surface();
    static Part part_of(int bone, const Shares& shares, const pbs::Positions& rest);
    static PartLag largest_lag_of(const std::vector<Part>& parts, double body, const pbs::Positions& positions,
                                  const pbs::Pose& pose);

    const pbs::Character& character_;
    double volume_m3_ = 0.0, area_m2_ = 0.0;  // of the body
    std::vector<Part> parts_, parts_of_surface_;
};

}  // namespace experiments
