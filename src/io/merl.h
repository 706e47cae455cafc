// MERL .binary files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/brdf_table.h"

namespace lightband::io {

// Parses the bytes of a MERL file; name stands in messages. LB_ERROR_FORMAT: wrong header, wrong size, a cell that is
// not finite. Any negative channel makes the cell "not measured".
BrdfTable parse_merl(const std::vector<uint8_t>& bytes, const std::string& name);
BrdfTable read_merl(const std::string& path);

// Writes the table as a MERL file (float64, channel-major, divided by the channel scales).
void write_merl(const std::string& path, const BrdfTable& table);

}  // namespace lightband::io
