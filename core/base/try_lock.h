#pragma once

namespace tetrace {

/// How an attempt to lock a file ended; failed: errno says why.
enum class LockAttempt { taken, held, failed };

/// Locks a whole open file against every other opening of it, on this machine and on others that share its folder; does
/// not wait. The system releases the lock when the file is closed, and so when the process ends.
/// A record lock of the open file (fcntl, F_OFD_SETLK), which NFS, Lustre and GPFS pass on to their servers; flock
/// where the file system has none.
[[nodiscard]] LockAttempt try_lock(int file);

} // namespace tetrace
