// Whole files: read into memory under a size limit, written to a temporary neighbour and renamed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lightband::io {

// Whether something of that name is there, whatever it is.
bool exists(const std::string& path);

// Reads all of path. LB_ERROR_FILE when it cannot be opened or read (with the system's reason) or is not a regular file,
// as folders, devices, sockets and pipes are not; nothing of these is waited for. LB_ERROR_FORMAT when it is larger than
// limit bytes.
std::vector<uint8_t> read_file(const std::string& path, uint64_t limit);

// Replaces path by a file of these bytes, or leaves path untouched and throws LB_ERROR_FILE. A new file's mode follows the
// umask; one that is replaced keeps its mode. Of a symbolic link, what it leads to is replaced.
void write_file(const std::string& path, const std::vector<uint8_t>& bytes);

}  // namespace lightband::io
