// The frames of CMU's clip 01_01 (100 Hz) that several studies measure.
//   read_scene("human_01_01", {}), clip_frames::crouch
#pragma once

namespace experiments::clip_frames {

inline constexpr int standing = 0, crouch = 164, in_the_air = 672, landing = 708;

}  // namespace experiments::clip_frames
