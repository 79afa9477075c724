// Any text as a skeleton: bones whose parents precede them, or an InputError.
#include "experiments/characters/skeleton_file.hpp"
#include "tests/fuzz/target.hpp"

void fuzz::try_input(const std::string& text)
{
    const pbs::Skeleton skeleton = pbs::parse_skeleton(text, "skeleton.toml");
    for (int bone = 0; bone < static_cast<int>(skeleton.bones.size()); ++bone)
        expect(skeleton.bones[bone].parent < bone && skeleton.bones[bone].head != skeleton.bones[bone].tail);
}
