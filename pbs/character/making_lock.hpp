// One process at a time makes the mesh of a key; the others wait, and find it in the cache.
//   const MakingLock lock(cache_folder(), key);
// A lock on one byte of the folder's file `making.lock`, chosen by the key's hash (fcntl(2), open file description locks), so that it ends
// with its process, however that one ends. Where the folder cannot be written, and after a signal, nothing is locked: then two make the
// same.
#pragma once

#include <string>

namespace pbs {

// Held from construction to destruction; not copied.
class MakingLock {
public:
    // Waits until no other process has it.
    MakingLock(const std::string& folder, const std::string& key);
    ~MakingLock();
    MakingLock(const MakingLock&) = delete;
    MakingLock& operator=(const MakingLock&) = delete;

private:
    int file_ = -1;
};

}  // namespace pbs
