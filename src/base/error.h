// Errors inside the library are exceptions; the border (src/api) turns each into a result code and a message.
#pragma once

#include <stdexcept>
#include <string>

#include "base/text.h"
#include "lightband/lightband.h"

namespace lightband {

class Error : public std::runtime_error {
public:
    Error(lb_result code, const std::string& message) : std::runtime_error(message), code_(code) {}
    lb_result code() const { return code_; }

private:
    lb_result code_;
};

}  // namespace lightband
