// Pixels that are shaded although they might be interpolated, chosen by chance: src/passes/uniforms.h, ChosenPixels. A part is the number
// of 2^32 hashes beside the first that are chosen; 0: none.
uniform uint validation_part, validation_seed, control_part, control_seed;

bool is_chosen_by(ivec2 at, uint part, uint seed) { return part > 0u && hash((uint(at.y) << 16 | uint(at.x)) ^ hash(seed)) <= part; }
bool is_chosen(ivec2 at) { return is_chosen_by(at, validation_part, validation_seed) || is_chosen_by(at, control_part, control_seed); }
