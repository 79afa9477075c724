#include "pbs/character/making_lock.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <functional>
#include <limits>

namespace pbs {

MakingLock::MakingLock(const std::string& folder, const std::string& key)
{
    file_ = ::open((folder + "/making.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0) return;
    struct flock byte = {};
    byte.l_type = F_WRLCK;
    byte.l_whence = SEEK_SET;
    byte.l_start = static_cast<off_t>(std::hash<std::string>()(key) & std::numeric_limits<int>::max());
    byte.l_len = 1;
    ::fcntl(file_, F_OFD_SETLKW, &byte);
}

MakingLock::~MakingLock()
{
    if (file_ >= 0) ::close(file_);
}

}  // namespace pbs
