// Pixels that are shaded whatever is decided for others, drawn by chance.
uniform uint witnesses;  // how many of 2^32 beside the first; 0: none
uniform uint seed;

bool is_chosen(ivec2 at) { return witnesses > 0u && hash((uint(at.y) << 16 | uint(at.x)) ^ hash(seed)) <= witnesses; }
