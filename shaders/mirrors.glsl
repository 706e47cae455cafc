// Where a mirror would send the eye's rays. Under distant light pixels of one material show nearby radiance where their mirror
// directions and normals are nearby, wherever they lie in the picture (docs/decisions/0012).

// What a pixel's neighbours want to know of it, in 16 bytes: the octahedral squares' 16 bits a coordinate are 1e-4 radians at most.
struct Mirror {
    vec3 normal, direction;  // unit
    float expected;          // luminance, by the pilots
    ivec2 at;
};

uvec4 words_of(Mirror mirror) {
    return uvec4(packUnorm2x16(octahedral(mirror.direction)), packUnorm2x16(octahedral(mirror.normal)), floatBitsToUint(mirror.expected),
                 uint(mirror.at.y) << 16 | uint(mirror.at.x));
}

Mirror mirror_of(uvec4 words) {
    return Mirror(octahedral_direction(unpackUnorm2x16(words.y)), octahedral_direction(unpackUnorm2x16(words.x)), uintBitsToFloat(words.z),
                  ivec2(words.w & 0xffffu, words.w >> 16));
}

// Mirror directions lie in the cells of octahedral squares: at level l, 2^l a side. A pixel asks for the coarsest level whose cells are
// fine enough for it; the bits of its word are that level and its cell there.
const int first_level = FIRST_LEVEL, last_level = LAST_LEVEL;
const int too_fine = TOO_FINE;  // level of what asks for finer cells than there are: it is shaded

uint cell_word(int level, ivec2 cell) { return uint(level) << 28 | uint(cell.y) << 14 | uint(cell.x); }
int level_of(uint word) { return int(word >> 28); }
ivec2 cell_of(uint word) { return ivec2(word & 0x3fffu, (word >> 14) & 0x3fffu); }

ivec2 cell_at(vec2 square, int level) {
    int side = 1 << level;
    return min(ivec2(square * float(side)), side - 1);
}

// Places in the tables of cells: slot by slot, level by level, row by row.
int cells_below(int level) { return ((1 << 2 * level) - (1 << 2 * first_level)) / 3; }
int cell_index(uint slot, int level, ivec2 cell) {
    return int(slot) * cells_below(last_level + 1) + cells_below(level) + (cell.y << level) + cell.x;
}

// What interpolation costs is held against bandwidth in tiles: the cells of the first level (src/picture/tiles.h).
int tile_of(uint slot, ivec2 cell) { return (int(slot) << 2 * first_level) + (cell.y << first_level) + cell.x; }

// Radians across a cell around a direction, by its solid angle.
float cell_width(vec3 direction, int level) {
    float reach = octahedral_reach(direction);
    return 2.0 * reach * sqrt(reach) / float(1 << level);
}

// One pixel speaks for a cell: of all that would, the one of highest rank, the last in the list of covered pixels. 0: none.
const uint place_mask = 0x3ffffffu;
uint claim(uint rank, uint place) { return rank << 26 | place; }

// 1 .. 31: how near a direction is to the middle of its cell. Evenly spaced ones are interpolated best.
uint closeness(vec2 square, int level, ivec2 cell) {
    vec2 off = square * float(1 << level) - vec2(cell) - 0.5;
    return 31u - uint(min(60.0 * dot(off, off), 30.0));
}
