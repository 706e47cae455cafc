// The lattice of level l holds the pixels whose coordinates are multiples of 2^l; a pixel that is new on lattice l lies midway between
// two or four parents on lattice l + 1 (section 3.2).

// The finest lattice's level, 0 .. coarsest, on which a pixel first appears.
int lattice_level(ivec2 at, int coarsest) {
    int bits = at.x | at.y;
    return bits == 0 ? coarsest : min(findLSB(uint(bits)), coarsest);
}

// From a pixel that is new on a lattice to its parents, one in each corner; midway between two, those of the lower corners are meant.
ivec2 towards_parent(ivec2 at, int level, int corner) {
    ivec2 sign = ivec2(corner & 1, corner >> 1) * 2 - 1;
    return sign * ((at >> level & 1) << level);
}
bool is_repeated(ivec2 at, int level, int corner) {
    ivec2 odd = at >> level & 1, upper = ivec2(corner & 1, corner >> 1);
    return any(greaterThan(upper, odd));
}

// The sum of a pixel's weights of its parents is 1; where something speaks against interpolation, so that shaded pixels alone are compared
// with it, it is `doubtful`. Between the two lies what rounding does not reach.
const float doubtful = 0.5, doubtful_below = 0.75;
