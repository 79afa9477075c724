// Reference: the permissions of the folder.
#include "experiments/command_line/verbs.hpp"

#include "pbs/geometry/input_error.hpp"
#include "tests/support/scratch_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include <sys/stat.h>
#include <unistd.h>

namespace {

using namespace experiments;
using test_support::ScratchFolder;
namespace fs = std::filesystem;

template <typename Work>
std::string refusal_of(const Work& work)
{
    try {
        work();
    } catch (const pbs::InputError& error) {
        return error.what();
    }
    return "accepted";
}

// Locks a folder. If root runs the tests, to whom modes do not apply, the process becomes another user meanwhile.
class Locked {
public:
    explicit Locked(const std::string& folder) : folder_(folder), self_(geteuid())
    {
        chmod(folder_.c_str(), 0);
        if (self_ == 0 && seteuid(65534) != 0) throw std::runtime_error("cannot become somebody else");
    }
    ~Locked()
    {
        if (seteuid(self_) == 0) chmod(folder_.c_str(), 0755);
    }

private:
    std::string folder_;
    uid_t self_;
};

TEST(FolderFiles, AFolderOfFramesThatIsLockedIsNamedWithTheReason)
{
    const ScratchFolder folder;
    fs::permissions(folder.path(), fs::perms(0755));
    const std::string frames = folder / "frames";
    fs::create_directories(frames);
    const Locked locked(frames);
    EXPECT_EQ(refusal_of([&] { frame_files({frames}); }), frames + ": the folder cannot be read: Permission denied");
    EXPECT_EQ(refusal_of([&] { frame_files({frames + "/f_%d.vtu"}); }), frames + ": the folder cannot be read: Permission denied");
}

}  // namespace
