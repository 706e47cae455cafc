// lightband.hpp alone, as the first header of a C++17 program. Compiling is the test.
#include "lightband/lightband.hpp"
